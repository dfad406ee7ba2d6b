"""Pieces of a self-contained page: quantities in an engineer's units, tables, tiles, sections."""
import base64
import html
import math
from dataclasses import dataclass, field
from string import Template
from typing import NamedTuple
from urllib.parse import quote

from rockwear.report import palette

SHOWN = {"N/m": ("kN/m", 1e-3, 0.0), "s": ("ms", 1e3, 0.0), "K": ("°C", 1.0, -273.15), "J/m3": ("MJ/m³", 1e-6, 0.0),
         "m": ("mm", 1e3, 0.0), "m3": ("cm³", 1e6, 0.0), "m3/m": ("mm³/mm", 1e6, 0.0), "bytes": ("MB", 1e-6, 0.0),
         "Pa": ("MPa", 1e-6, 0.0), "-": ("", 1.0, 0.0)}
"""How a unit of the files is shown: unit, factor, and what is added after it."""
LARGE = {"s": (1.0, "s", 1.0, 0.0), "m": (1.0, "m", 1.0, 0.0), "N": (2e3, "kN", 1e-3, 0.0),
         "Pa": (1e9, "GPa", 1e-9, 0.0)}
"""The same of values from a size on: size, unit, factor, what is added."""

LOOK = Template("""
body {font: 15px/1.45 system-ui, sans-serif; color: $text; background: $back}
body {max-width: 1100px; margin: 0 auto; padding: 1.5em}
h1 {margin: 0} h2 {margin: 2em 0 .2em; border-bottom: 2px solid $rule; padding-bottom: .15em}
p {margin: .4em 0 .8em} .ended {color: $faint; font-size: 1.1em}
.warning {background: $warning; border-left: 4px solid $warning_edge; padding: .4em .8em}
img {max-width: 100%; display: block; margin: .5em auto}
.tiles {display: grid; grid-template-columns: repeat(5, 1fr); gap: 10px; margin: 1em 0}
@media (max-width: 1000px) {.tiles {grid-template-columns: repeat(3, 1fr)}}
@media (max-width: 600px) {.tiles {grid-template-columns: repeat(2, 1fr)}}
.tile {background: $panel; border-radius: 6px; padding: .5em .8em}
.tile b {display: block; font-size: 1.35em; white-space: nowrap}
.tile span {color: $faint; font-size: .85em; display: block}
table {border-collapse: collapse; margin: .6em 0} th {text-align: left; background: $panel}
td, th {padding: .2em .9em .2em .5em; border-bottom: 1px solid $line; vertical-align: top}
td.number {text-align: right; font-variant-numeric: tabular-nums}
.beside {display: flex; flex-wrap: wrap; gap: 0 3em} caption {text-align: left; font-weight: bold; padding: .3em 0}
details {margin: 1em 0} summary {cursor: pointer; font-weight: bold}
""").substitute(palette.PAGE)


@dataclass
class Section:
    """A heading, a sentence on what to see, and pieces of html; what is empty is left out."""

    title: str
    words: str
    pieces: list = field(default_factory=list)

    def html(self):
        """As html."""
        pieces = [piece for piece in self.pieces if piece]
        if not pieces:
            return ""
        words = f"<p>{html.escape(self.words)}</p>\n" if self.words else ""
        return f"<h2>{html.escape(self.title)}</h2>\n{words}" + "\n".join(pieces)


def number(value):
    """A number as an engineer would write it; text as it is."""
    if isinstance(value, (bool, str, int)) or value is None:
        return str(value)
    if not math.isfinite(value):
        return "not known" if math.isnan(value) else str(value)
    # -0.0 is 0.
    return f"{value:.0f}" if abs(value) >= 1000 else f"{value + 0.0:.3g}"


def shown_unit(unit, size):
    """(unit, factor, what is added) in which values of about this size are shown."""
    if unit in LARGE and abs(size) >= LARGE[unit][0]:
        return LARGE[unit][1:]
    return SHOWN.get(unit, (unit, 1.0, 0.0))


def quantity(value, unit):
    """Value and unit as shown: quantity(12e3, "N/m") is "12 kN/m"."""
    if isinstance(value, str):
        return value
    shown, factor, added = shown_unit(unit, value)
    if (factor, added) != (1.0, 0.0):
        value = value * factor + added
    return f"{number(value)} {shown if math.isfinite(value) else ''}".strip()


def with_error(value, error, unit):
    """A mean and its standard error, rounded to two digits of the error; the mean alone where the error is not known:
    with_error(123.4e3, 5.67e3, "N/m") is "123.4 ± 5.7 kN/m"."""
    shown, factor, added = shown_unit(unit, value)
    error = abs(factor) * error
    if not (math.isfinite(value) and math.isfinite(error) and error > 0):
        return quantity(value, unit)
    places = max(0, 1 - math.floor(math.log10(error)))
    return f"{factor * value + added:.{places}f} ± {error:.{places}f} {shown}".strip()


def percent(part, whole):
    """Part of a whole in per cent; not known without a whole."""
    share = 100 * part / whole if whole else math.nan
    if not math.isfinite(share):
        return "not known"
    return f"{share:.1f} %" if abs(share) >= 1 else f"{share:.2g} %"


def duration(seconds):
    """Wall time."""
    if not seconds >= 60:
        return f"{number(seconds)} s"
    minutes, hours = int(seconds / 60) % 60, int(seconds / 3600)
    return f"{hours} h {minutes} min" if hours else f"{minutes} min {int(seconds) % 60} s"


def words(name):
    """A name of the files in words."""
    return name.replace("_", " ")


class Link(NamedTuple):
    """A cell of a table that leads to a place."""

    text: str
    place: str


def _cell(content):
    if isinstance(content, Link):
        return f'<a href="{html.escape(quote(content.place))}">{html.escape(content.text)}</a>'
    return html.escape(str(content))


def table(rows, header=(), caption=""):
    """An html table; every cell but the first of a row is set as a number."""
    parts = [f"<caption>{html.escape(caption)}</caption>"] if caption else []
    if header:
        parts.append("<tr>" + "".join(f"<th>{html.escape(str(cell))}</th>" for cell in header) + "</tr>")
    for first, *others in rows:
        cells = "".join(f'<td class="number">{_cell(cell)}</td>' for cell in others)
        parts.append(f"<tr><td>{_cell(first)}</td>{cells}</tr>")
    return "<table>" + "\n".join(parts) + "</table>"


def tiles(entries):
    """The numbers to see first: [(label, value, remark)]; empty without any."""
    if not entries:
        return ""
    cells = [[html.escape(word) for word in entry] for entry in entries]
    return '<div class="tiles">' + "\n".join(
        f'<div class="tile"><span>{label}</span><b>{value}</b><span>{remark}</span></div>'
        for label, value, remark in cells) + "</div>"


def heading(text):
    """A heading within a section."""
    return f"<h3>{html.escape(text)}</h3>"


def image(path):
    """A picture of the disk, inside the page."""
    kind = path.suffix.lstrip(".")
    data = base64.b64encode(path.read_bytes()).decode()
    return f'<img src="data:image/{kind};base64,{data}" alt="{html.escape(words(path.stem))}">'


def folded(title, *pieces):
    """Pieces behind a title that opens them."""
    return f"<details><summary>{html.escape(title)}</summary>\n" + "\n".join(pieces) + "</details>"


def beside(*pieces):
    """Pieces side by side as far as there is room; empty where all are."""
    inside = "\n".join(f"<div>{piece}</div>" for piece in pieces if piece)
    return f'<div class="beside">{inside}</div>' if inside else ""


def document(title, remark, sections, warnings=()):
    """A whole page of sections, below lines on what is not to be relied on."""
    title, body = html.escape(title), "\n".join(section.html() for section in sections)
    body = "".join(f'<p class="warning">{html.escape(line)}</p>\n' for line in warnings) + body
    head = f'<head><meta charset="utf-8"><title>{title}</title>\n<style>{LOOK}</style></head>'
    return (f'<!DOCTYPE html>\n<html lang="en">{head}\n<body><h1>{title}</h1>\n'
            f'<p class="ended">{html.escape(remark)}</p>\n{body}\n</body></html>\n')
