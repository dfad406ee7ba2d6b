"""Rock files: what a rock is to be, the micro-parameters that make it so, and what the laboratory measured of them.

A file is JSON, all of it in SI::

    {"format": 1, "name": "...", "source": "...",
     "targets": {PROPERTY: {"value": 18e9, "unit": "Pa"}, ...},
     "plane": {"parameters": {NAME: value, ...},
               "resolution": {"radius_min": 1e-3, "radius_max": 1.5e-3},
               "measured": {PROPERTY: {"mean": 17.9e9, "standard_deviation": 2e8, "packings": 5, "unit": "Pa"}, ...}},
     "space": {the same, but "resolution": {"radius": 9e-3}}}

It has a part for the plane, one for space, or both. PROPERTY: one of PROPERTIES; targets and measured may be empty. The
triaxial strengths are a list of [sigma3, sigma1], their standard_deviation a list. Parameters are those of the bond law
with bond_law, bonding_gap and porosity; other parameters of the rock may be there too.
"""
import difflib
import json
from dataclasses import dataclass
from pathlib import Path

from rockwear.kernels.checks import ParameterError, finite, require
from rockwear.kernels.parameter import Presets, unmet

FORMAT = 1
LIBRARY = Path(__file__).resolve().parents[1] / "rocks"
"""The rocks that come with the package."""
STRENGTH = 1e4, 1e9
"""Pa. Ranges of properties hold every rock and soil, and are narrow enough that a slip of 1e6 in the unit falls out."""
PROPERTIES = {
    "youngs_modulus": ("Pa", 1e7, 1e12), "poissons_ratio": ("", -1.0, 0.5), "ucs": ("Pa", *STRENGTH),
    "tensile_strength": ("Pa", *STRENGTH), "fracture_toughness": ("Pa sqrt(m)", 1e3, 1e8),
    "fracture_energy": ("J/m2", 0.01, 1e4), "friction_angle": ("deg", 2.0, 89.0), "cohesion": ("Pa", *STRENGTH),
    "hoek_brown_m": ("", 0.1, 100.0), "hoek_brown_sigma_ci": ("Pa", *STRENGTH), "triaxial": ("Pa", 0.0, 1e10)}
"""{property of a rock: (unit, least, largest)}."""
LARGEST_STRAIN = 0.1
"""UCS over Young's modulus: no rock is shortened so much before it fails."""
BOND_STRESS = {"N/m": (1e6, 1e13), "N": (1e3, 1e11)}
"""Pa, least and largest stiffness and strength of a bond over its area, by the unit; see PROPERTIES."""
RADIUS = 1e-6, 0.1
"""m."""
RADII = {"plane": ("radius_min", "radius_max"), "space": ("radius",)}
"""Names of a part's resolution, which are parameters of the scenes too."""
DIMENSION = {"plane": 0, "space": 1}
"""Place of a part's power in size_power."""
MEASURED_WITHIN = {False: 2.5, True: 5.0}
"""Factor of the size within which a rock is taken for the one that was measured: without powers of its strengths, and
with them."""
OPTIONAL = "rock_density", "rotation", "crushing_hardening"
"""Parameters that a file may leave out: the scene's defaults count."""


@dataclass(frozen=True)
class Part:
    """A rock in the plane or in space. parameters: {name: checked value}; resolution: {name: m}; measured:
    {property: {"mean", "standard_deviation", "packings"}}."""

    parameters: dict
    resolution: dict
    measured: dict


@dataclass(frozen=True)
class RockFile:
    """A rock as its file has it. targets: {property: value}; parts: {"plane" or "space": Part}."""

    name: str
    source: str
    targets: dict
    parts: dict


def library():
    """Names of the rocks that come with the package."""
    return sorted(file.stem for file in LIBRARY.glob("*.json"))


def find(word):
    """Path of a rock: a name of the library, or else a file. Raises ParameterError (rock)."""
    if word in library():
        return LIBRARY / f"{word}.json"
    path = Path(word)
    try:
        there = path.is_file()
    except OSError:
        there = False
    if not there:
        close = difflib.get_close_matches(word, library(), n=1)
        raise ParameterError("rock", word, f"a file, or one of {', '.join(library())}"
                             + (f"; did you mean {close[0]}" if close else ""))
    return path


def read(path, declared):
    """The RockFile at `path`, all of it checked. declared: {name: Parameter} of what its parameters may be; all but
    flags and OPTIONAL are needed where the bond law uses them.

    Raises ParameterError (rock), with the place in the file.
    """
    try:
        data = json.loads(Path(path).read_text(encoding="utf-8-sig"), object_pairs_hook=_object)
    except (OSError, ValueError, RecursionError) as error:
        raise ParameterError("rock", str(path), f"a readable JSON file ({str(error).splitlines()[0]})") from None
    try:
        return _rock(data, declared)
    except ParameterError as error:
        shown = f"{error.value:g}" if isinstance(error.value, float) else str(error.value)
        raise ParameterError("rock", f"{path}, {error.name} = {shown}{' ' + error.unit if error.unit else ''}",
                             error.rule) from None


def _object(pairs):
    names = [name for name, _ in pairs]
    twice = sorted({name for name in names if names.count(name) > 1})
    if twice:
        raise ValueError(f"{twice[0]} is there twice")
    return dict(pairs)


def _rock(data, declared):
    entries = _entries("the file", data, ("format", "name", "source", "targets"), tuple(RADII))
    require(data["format"] == FORMAT, "format", data["format"], f"{FORMAT}, the format that this version reads")
    for name in ("name", "source"):
        require(isinstance(data[name], str) and data[name].strip(), name, data[name], "a text")
    parts = {kind: _part(kind, entries[kind], declared) for kind in RADII if kind in entries}
    require(parts, "the file", "no part", f"with a part for {' or '.join(RADII)}")
    return RockFile(name=data["name"], source=data["source"], targets=_targets(data["targets"]), parts=parts)


def _entries(where, found, needed, others=()):
    """`found`, a JSON object with all names of `needed` and no others but those of `others`."""
    require(isinstance(found, dict), where, json.dumps(found)[:40], "an object, {...}")
    missing = [name for name in needed if name not in found]
    require(not missing, where, ", ".join(found) or "{}", f"with the key {', '.join(missing)}")
    known = (*needed, *others)
    for name in found:
        close = difflib.get_close_matches(name, known, n=1)
        require(name in known, where, name, f"one of {', '.join(known)}{f'; did you mean {close[0]}' if close else ''}")
    return found


def _number(name, value, unit=""):
    require(isinstance(value, (int, float)) and not isinstance(value, bool), name, json.dumps(value)[:40],
            "a number", unit)
    return finite(name, value, unit)


def _between(name, value, low, high, unit=""):
    number = _number(name, value, unit)
    require(low <= number <= high, name, number, f"between {low:g} and {high:g} (in {unit or 'no unit'})", unit)
    return number


def _targets(found):
    targets = {}
    for name, entry in _entries("targets", found, (), PROPERTIES).items():
        place = f"targets.{name}"
        _entries(place, entry, ("value", "unit"))
        targets[name] = _property(name, place, entry["value"], entry["unit"])
    check_properties(targets)
    return targets


def _property(name, place, value, unit):
    expected, low, high = PROPERTIES[name]
    require(unit == expected, f"{place}.unit", unit, f"{expected or 'empty'}: properties are in SI units")
    if name != "triaxial":
        return _between(place, value, low, high, unit)
    require(isinstance(value, list) and value and all(isinstance(pair, list) and len(pair) == 2 for pair in value),
            place, json.dumps(value)[:40], "a list of [sigma3, sigma1]")
    pairs = [(_between(f"{place}, sigma3", least, 0.0, STRENGTH[1], unit),
              _between(f"{place}, sigma1", largest, STRENGTH[0], high, unit)) for least, largest in value]
    for least, largest in pairs:
        require(largest > least, f"{place}, sigma1", largest, f"more than sigma3 = {least:g}", unit)
        require(least == 0 or least >= 0.1 * STRENGTH[0], f"{place}, sigma3", least,
                f"0 or at least {0.1 * STRENGTH[0]:g}", unit)
    return pairs


def check_properties(found, place="targets"):
    """Raise ParameterError for properties {name: value} that no rock has together."""
    ucs, modulus, tension = (found.get(name) for name in ("ucs", "youngs_modulus", "tensile_strength"))
    if ucs and tension:
        require(ucs > tension, f"{place}.ucs", ucs, f"more than tensile_strength = {tension:g}", "Pa")
    if ucs and modulus:
        require(ucs <= LARGEST_STRAIN * modulus, f"{place}.youngs_modulus", modulus,
                f"at least {1 / LARGEST_STRAIN:g} times ucs = {ucs:g}", "Pa")


def _part(kind, found, declared):
    _entries(kind, found, ("parameters", "resolution", "measured"))
    resolution = {name: _between(f"{kind}.resolution.{name}", value, *RADIUS, "m") for name, value in
                  _entries(f"{kind}.resolution", found["resolution"], RADII[kind]).items()}
    least, *largest = (resolution[name] for name in RADII[kind])
    for radius in largest:
        require(radius >= least, f"{kind}.resolution.radius_max", radius, f"at least radius_min = {least:g}", "m")
    return Part(parameters=_parameters(kind, found["parameters"], declared, size(resolution)), resolution=resolution,
                measured=_measured(kind, found["measured"]))


def size(resolution):
    """Mean radius, m, of {name of RADII: m}."""
    return sum(resolution.values()) / len(resolution)


def _parameters(kind, found, declared, radius):
    """{name: value} by the rules of the declared parameters, with the parameters that the bond law uses alone."""
    place = f"{kind}.parameters"
    _entries(place, found, ("bond_law",), tuple(declared))
    values = {name: _checked(place, parameter, found.get(name, parameter.default))
              for name, parameter in declared.items()}
    used = [name for name, parameter in declared.items() if unmet(parameter, values, declared) is None]
    for name in found:
        require(name in used, f"{place}.{name}", values[name], f"left out with bond_law = {found['bond_law']}",
                declared[name].unit)
    # What is none by default may be left out.
    _entries(place, found, [name for name in used if declared[name].default and name not in OPTIONAL], used)
    for name in found:
        _check_stress(place, declared[name], values[name], (2 * radius)**declared[name].size_power[DIMENSION[kind]])
    return {name: values[name] for name in found}


def _checked(place, parameter, value):
    if isinstance(parameter.default, (int, float)) and not isinstance(parameter.default, bool):
        value = _number(f"{place}.{parameter.name}", value, parameter.unit)
    try:
        return parameter.check(value)
    except ParameterError as error:
        raise ParameterError(f"{place}.{error.name}", error.value, error.rule, error.unit) from None


def _check_stress(place, parameter, value, area):
    """Raise ParameterError for a stiffness or strength that no bond of this size has."""
    if parameter.unit in BOND_STRESS and value:
        low, high = BOND_STRESS[parameter.unit]
        require(low * area <= abs(value) <= high * area, f"{place}.{parameter.name}", value,
                f"between {low * area:.2g} and {high * area:.2g} at this resolution", parameter.unit)


def _measured(kind, found):
    measured = {}
    for name, entry in _entries(f"{kind}.measured", found, (), PROPERTIES).items():
        place = f"{kind}.measured.{name}"
        _entries(place, entry, ("mean", "standard_deviation", "packings", "unit"))
        mean = _property(name, place, entry["mean"], entry["unit"])
        spread = entry["standard_deviation"]
        require(isinstance(spread, list) == isinstance(mean, list), f"{place}.standard_deviation",
                json.dumps(spread)[:40], "a number; of triaxial a list")
        spreads = [_number(f"{place}.standard_deviation", one, entry["unit"])
                   for one in (spread if isinstance(spread, list) else [spread])]
        require(min(spreads, default=-1) >= 0 and len(spreads) == (len(mean) if isinstance(mean, list) else 1),
                f"{place}.standard_deviation", json.dumps(spread)[:40], "at least 0, one of each mean", entry["unit"])
        count = _number(f"{place}.packings", entry["packings"])
        require(count == int(count) and count >= 1, f"{place}.packings", count, "a whole number of at least 1")
        measured[name] = {"mean": mean, "standard_deviation": spread, "packings": int(count)}
    check_properties({name: entry["mean"] for name, entry in measured.items()}, f"{kind}.measured")
    return measured


class RockPresets(Presets):
    """The values that the file of a rock gives a scene.

    declared: {name: Parameter} of what its parameters may be; only: names of those that the scene has a use for, None
    for all; scaled: names of those that the scene multiplies by scale_factor^size_power, None for all.

    Values hold at the resolution of the file and are converted to the radii of the scene by
    Parameter.size_power and a power that the file may have, NAME_power, with the mean of the smallest and largest
    radius for the size. Elasticity and the strengths of bonds then stay, and with such powers those of the rock.
    Toughness stays with the laws whose strengths are in Pa alone: a bond of the damage law takes Rn^2/2 (1/kn + 1/H)
    over its part of the crack to break, which grows with the radius as long as H does not.

    A scene with a scale_factor has radii scale_factor times as large as its parameters say. Values are then such that
    with the scene's own factors they are right there.
    """

    metavar = "NAME|FILE"

    def __init__(self, declared, *, only=None, scaled=None):
        super().__init__()
        self.declared, self.only, self.scaled = declared, only, scaled

    def path(self, value):
        """Path of the rock."""
        return find(value)

    def read(self, value, values):
        """(RockFile, name of its part) for a scene of these values. Raises ParameterError."""
        rock = read(find(value), self.declared)
        kind = next(kind for kind, names in RADII.items() if all(name in values for name in names))
        require(kind in rock.parts, "rock", value, f"a rock with a part for the {kind}: it has one for the "
                f"{' and the '.join(rock.parts)} alone")
        return rock, kind

    def warnings(self, value, values):
        rock, kind = self.read(value, values)
        part = rock.parts[kind]
        ratio = values.get("scale_factor", 1.0) * self._ratio(part, kind, values)
        measured = size(part.resolution)
        within = MEASURED_WITHIN[any(name.endswith("_power") for name in part.parameters)]
        if not part.measured or self.only is not None or 1 / within <= ratio <= within:
            return []
        way, factor = ("larger", ratio) if ratio > 1 else ("smaller", 1 / ratio)
        return [f"the rock's particles are {factor:.3g} times {way} than those of {measured:.3g} m in mean radius that "
                f"{rock.name} was measured with: what is known of its strength does not hold at this size"]

    @staticmethod
    def _ratio(part, kind, values):
        """Mean radius of the scene over that of the rock's file."""
        return size({name: values[name] for name in RADII[kind]}) / size(part.resolution)

    def defaults(self, value, values):
        """{name: value} that are right at the radii of the scene."""
        rock, kind = self.read(value, values)
        part = rock.parts[kind]
        found = {name: part.parameters[name] for name in part.parameters if self.only is None or name in self.only}
        for name in found:
            require(name in values, "rock", f"{value}, {kind}.parameters.{name} = {found[name]}",
                    "a known parameter (--help lists them)")
        factor = values.get("scale_factor", 1.0)
        ratio = self._ratio(part, kind, values)
        for name in found:
            own = self.declared[name].size_power[DIMENSION[kind]]
            power = own + part.parameters.get(f"{name}_power", 0.0)
            taken = own if self.scaled is None or name in self.scaled else 0
            if power or taken:
                found[name] *= ratio**power * factor**(power - taken)
        return found
