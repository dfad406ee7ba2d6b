"""How many runs there are, and how they stand, on one line."""
import re
import sys
import time

from rockwear.report.page import duration

PERCENT = re.compile(rb"(\d+\.\d) %  t = ")
"""In the lines that a run says about itself."""
TAIL = 4096
"""Bytes at the end of a log in which its last such line is."""


class Progress:
    """Says on one line how many runs are done, how many failed, and the time left. runs: of campaigns.runs.Started."""

    def __init__(self, runs):
        self.runs, self.begin, self.failed = list(runs), time.time(), 0
        self.terminal = sys.stdout.isatty()
        self.period = 1 if self.terminal else 10
        self.at_first = self._part()
        self.next_word = 0.0

    def _part(self):
        """Part of all that is done, by the runs' own words."""
        return sum(1.0 if one.over else _percent(one.log) / 100 for one in self.runs) / len(self.runs)

    def show(self):
        """Say how it stands, once a period."""
        ended = sum(one.over for one in self.runs)
        if time.time() < self.next_word and ended < len(self.runs):
            return
        self.next_word = time.time() + self.period
        part = self._part()
        gained = part - self.at_first
        remaining = (time.time() - self.begin) * (1 - part) / gained if gained > 1e-6 else None
        words = f"{ended - self.failed} of {len(self.runs)} runs done, {self.failed} failed, {100 * part:.1f} %, " + (
            f"{duration(round(remaining))} left" if remaining is not None else "time left not known yet")
        print(f"\r{words}\033[K" if self.terminal else words, end="" if self.terminal else "\n", flush=True)

    def clear(self):
        """Make room for a line of another's."""
        if self.terminal:
            print("\r\033[K", end="", flush=True)
            self.next_word = 0.0

    def close(self):
        """End the line."""
        if self.terminal:
            print()


def _percent(log):
    """Of a run that has not ended, by the last line of its log that says so."""
    try:
        with open(log, "rb") as file:
            file.seek(0, 2)
            file.seek(max(0, file.tell() - TAIL))
            found = PERCENT.findall(file.read())
    except OSError:
        return 0.0
    return float(found[-1]) if found else 0.0
