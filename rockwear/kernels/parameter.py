"""Parameters and their rules: name, default, unit, meaning, source."""
from dataclasses import dataclass
from typing import Any, Callable

from rockwear.kernels.checks import finite, require


def number(low=None, high=None):
    """A rule: a finite number in [low, high]."""
    def rule(name, value, unit):
        found = finite(name, value, unit)
        require(low is None or found >= low, name, found, f"at least {low:g}" if low is not None else "", unit)
        require(high is None or found <= high, name, found, f"at most {high:g}" if high is not None else "", unit)
        return found
    return rule


def above_zero(name, value, unit):
    """A rule: a finite number greater than 0."""
    found = finite(name, value, unit)
    require(found > 0, name, found, "greater than 0", unit)
    return found


def integer(low):
    """A rule: a whole number of at least `low`."""
    def rule(name, value, unit):
        found = finite(name, value, unit)
        require(found == int(found) and found >= low, name, value, f"a whole number of at least {low}", unit)
        return int(found)
    return rule


def numbers(each):
    """A rule: numbers with commas between them, each after the rule `each`."""
    def rule(name, value, unit):
        return ",".join(f"{each(name, word.strip(), unit):g}" for word in str(value).split(","))
    return rule


def listed(text):
    """The numbers of a parameter that `numbers` has checked."""
    return [float(word) for word in text.split(",")]


def flag(name, value, unit):
    """A rule: true or false."""
    words = {"true": True, "1": True, "yes": True, "false": False, "0": False, "no": False}
    require(str(value).lower() in words, name, value, "true or false")
    return words[str(value).lower()]


def choice(*options):
    """A rule: one of these words."""
    def rule(name, value, unit):
        require(str(value) in options, name, value, f"one of {', '.join(options)}")
        return str(value)
    return rule


def text(name, value, unit):
    """A rule: any text."""
    return str(value)


def file(name, value, unit):
    """A rule: the path of a file, or nothing; what is in it the scene looks at."""
    return str(value)


@dataclass(frozen=True)
class Parameter:
    """One number of a scene: its name, default, unit, rule, meaning, and where the default comes from."""

    name: str
    default: Any
    unit: str
    rule: Callable
    meaning: str
    source: str = "ours"

    def check(self, value):
        """The value as the rule's type. Raises ParameterError."""
        return self.rule(self.name, value, self.unit)
