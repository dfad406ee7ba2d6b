"""How a sweep stands, on one line."""
import re
import sys
import time

from rockwear.report.page import duration

PERCENT = re.compile(rb"(\d+\.\d) %  t = ")
"""In the lines that a run says about itself."""
TAIL = 4096
"""Bytes at the end of a log in which its last such line is."""


class Progress:
    """Says on one line how many rows are done, how many run, and the time left. rows: of the sweep."""

    def __init__(self, rows):
        self.rows, self.begin = rows, time.time()
        self.terminal = sys.stdout.isatty()
        self.period = 1 if self.terminal else 10
        self.at_first = self._part({row.name for row in rows if not row.done})
        self.next_word = 0.0

    def _part(self, left):
        """Part of the sweep that is done, by the runs' own words."""
        return sum(_percent(row) / 100 if row.name in left else 1.0 for row in self.rows) / len(self.rows)

    def show(self, left):
        """Say how it stands. left: names of the rows that have not ended."""
        if time.time() < self.next_word and left:
            return
        self.next_word = time.time() + self.period
        part, ended = self._part(left), len(self.rows) - len(left)
        failed = sum(bool(row.failure) for row in self.rows)
        gained = part - self.at_first
        remaining = (time.time() - self.begin) * (1 - part) / gained if gained > 1e-6 else None
        words = f"{ended - failed} of {len(self.rows)} rows done, {failed} failed, {100 * part:.1f} %, " + (
            f"{duration(round(remaining))} left" if remaining is not None else "time left not known yet")
        print(f"\r{words}\033[K" if self.terminal else words, end="" if self.terminal else "\n", flush=True)

    def say(self, line, stream):
        """Say a line of its own."""
        print(f"\r\033[K{line}" if self.terminal else line, file=stream, flush=True)

    def close(self):
        """End the line."""
        if self.terminal:
            print()


def _percent(row):
    """Of a row that has not ended, by the last line of its log that says so."""
    try:
        with open(row.job["log"], "rb") as log:
            log.seek(0, 2)
            log.seek(max(0, log.tell() - TAIL))
            found = PERCENT.findall(log.read())
    except OSError:
        return 0.0
    return float(found[-1]) if found else 0.0
