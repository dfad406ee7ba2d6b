"""Parameters, their rules and groups: name, default, unit, meaning, source, and when they are used."""
from abc import ABC, abstractmethod
from dataclasses import dataclass, replace
from typing import Any, Callable

from rockwear.kernels.checks import ParameterError, finite, require


def number(low=None, high=None):
    """A rule: a finite number in [low, high]."""
    def rule(name, value, unit):
        found = finite(name, value, unit)
        require(low is None or found >= low, name, found, f"at least {low:g}" if low is not None else "", unit)
        require(high is None or found <= high, name, found, f"at most {high:g}" if high is not None else "", unit)
        return found
    return rule


def zero_or(low, high):
    """A rule: 0, which leaves something out, or a number in [low, high]."""
    def rule(name, value, unit):
        found = finite(name, value, unit)
        require(found == 0 or low <= found <= high, name, found, f"0 or between {low:g} and {high:g}", unit)
        return found
    return rule


def above_zero(name, value, unit):
    """A rule: a finite number greater than 0."""
    found = finite(name, value, unit)
    require(found > 0, name, found, "greater than 0", unit)
    return found


def plausible(low, high):
    """A rule: a number greater than 0 and in [low, high], bounds so wide that no material or process is outside."""
    def rule(name, value, unit):
        found = above_zero(name, value, unit)
        require(low <= found <= high, name, found, f"between {low:g} and {high:g}", unit)
        return found
    return rule


RENAMED_IN = "0.2"
"""The version that renamed parameters and values."""

stiffness = plausible(1.0, 1e15)
"""A rule: N/m, of a contact or a bond."""
density = plausible(100.0, 1e6)
"""A rule: kg/m3."""
speed = plausible(1e-9, 1e5)
"""A rule: m/s."""
duration = plausible(1e-12, 1e8)
"""A rule: s, up to three years."""
length = plausible(1e-9, 1e6)
"""A rule: m, of a particle as of a sliding distance."""
length_or_zero = zero_or(1e-9, 1e6)
"""A rule: m, as `length`, or 0."""


def integer(low, high=None):
    """A rule: a whole number in [low, high]."""
    def rule(name, value, unit):
        found = finite(name, value, unit)
        require(found == int(found) and found >= low, name, value, f"a whole number of at least {low}", unit)
        require(high is None or found <= high, name, value, f"a whole number of at most {high}", unit)
        return int(found)
    return rule


def numbers(each):
    """A rule: numbers with commas between them, each checked by the rule `each`."""
    def rule(name, value, unit):
        return ",".join(_shortest(each(name, word.strip(), unit)) for word in str(value).split(","))
    return rule


def _shortest(value):
    """A number as text that is read as the same number."""
    return next(text for text in (f"{value:g}", repr(value)) if float(text) == value)


def listed(text):
    """The numbers of a parameter that `numbers` has checked."""
    return [float(word) for word in text.split(",")]


def flag(name, value, unit):
    """A rule: true or false."""
    words = {"true": True, "1": True, "yes": True, "false": False, "0": False, "no": False}
    require(str(value).lower() in words, name, value, "true or false")
    return words[str(value).lower()]


def choice(*options, renamed=None):
    """A rule: one of these words. renamed: {old word: the option that replaces it}."""
    def rule(name, value, unit):
        word = str(value)
        if word not in options and word in (renamed or {}):
            raise ParameterError(name, word, f"given as {renamed[word]}, its name since {RENAMED_IN}")
        require(word in options, name, word, f"one of {', '.join(options)}")
        return word
    rule.options = options
    return rule


def text(name, value, unit):
    """A rule: any text."""
    return str(value)


def words(name, value, unit):
    """A rule: a text that is not empty."""
    require(str(value).strip(), name, value, "a text")
    return str(value)


def file(name, value, unit):
    """A rule: the path of a file, or nothing. The scene checks the contents."""
    return str(value)


class Presets(ABC):
    """What gives other parameters their defaults: a rule, or a file. metavar: what help calls the value of a file."""

    metavar = ""

    def path(self, value):
        """Path of the file that the parameter's value names; None of a rule. Raises ParameterError where it is not."""

    @abstractmethod
    def defaults(self, value, values):
        """{name: value} of other parameters. values: of all parameters, with the defaults of presets declared before.

        Raises ParameterError for a file that cannot be used.
        """

    def warnings(self, value, values):
        """Lines on what is not to be relied on where they give defaults. values: of all parameters, as of `read`."""
        return []


class Fixed(Presets):
    """The same values {name: value} wherever a flag is set."""

    def __init__(self, **values):
        super().__init__()
        self.values = values

    def defaults(self, value, values):
        return self.values


@dataclass(frozen=True)
class Above:
    """The numbers above `low`, as a condition of Parameter.when."""

    low: float

    def __contains__(self, value):
        return value > self.low


@dataclass(frozen=True)
class Parameter:
    """One value that a user may give.

    name, default, unit (SI; "" without one), rule, meaning, source: where the default comes from
    when: {name of another parameter: (values,) or Above}: used only where every other has one of these values. A
    condition on a parameter that a scene does not declare is met.
    size_power: powers of the size of the rock's particles with which the value grows, in the plane and in space, so
    that the rock stays the same: lengths grow with it, stresses stay
    presets: of a parameter whose value gives others their defaults: see Presets
    """

    name: str
    default: Any
    unit: str
    rule: Callable
    meaning: str
    source: str = "ours"
    when: dict | None = None
    size_power: tuple = (0, 0)
    presets: Any = None

    def check(self, value):
        """The value as the rule's type. Raises ParameterError."""
        return self.rule(self.name, value, self.unit)


@dataclass(frozen=True)
class Group:
    """Parameters that belong together. Iterating gives each with the group's own `when` added to that of the parameter.

    A parameter that the group's `when` asks for may be one of the group: it is used in any case.
    """

    title: str
    parameters: tuple
    when: dict | None = None

    def __post_init__(self):
        object.__setattr__(self, "parameters", tuple(self.parameters))

    def __iter__(self):
        for parameter in self.parameters:
            if not self.when or parameter.name in self.when:
                yield parameter
            else:
                yield replace(parameter, when={**self.when, **(parameter.when or {})})

    def with_defaults(self, **defaults):
        """The group with other defaults. Raises KeyError for a name that is not of the group."""
        self._own(defaults)
        return self._with(replace(p, default=defaults.get(p.name, p.default)) for p in self.parameters)

    def without(self, *names):
        """The group without these parameters. Raises KeyError for a name that is not of the group."""
        self._own(names)
        return self._with(p for p in self.parameters if p.name not in names)

    def only(self, *names):
        """The group with these parameters alone. Raises KeyError for a name that is not of the group."""
        self._own(names)
        return self._with(p for p in self.parameters if p.name in names)

    def _own(self, names):
        unknown = set(names) - {parameter.name for parameter in self.parameters}
        if unknown:
            raise KeyError(f"not in the group {self.title}: {', '.join(sorted(unknown))}")

    def _with(self, parameters):
        return replace(self, parameters=tuple(parameters))


def unmet(parameter, values, declared):
    """Name of the parameter whose value keeps `parameter` from being used; None where it is used.

    values: {name: value}; declared: {name: Parameter}. A parameter that is not used itself counts with its default.
    """
    for name, allowed in (parameter.when or {}).items():
        if name in declared:
            used = unmet(declared[name], values, declared) is None
            if (values[name] if used else declared[name].default) not in allowed:
                return name
    return None


def law_parameters(registry, choice):
    """Parameters of all laws in `registry`, {name: class with `parameters`}, each once.

    choice: name of the parameter that chooses the law; `when` names it, where not every law has the parameter.
    Raises ValueError where two laws declare one name differently.
    """
    found, laws = {}, {}
    for law, kind in registry.items():
        for parameter in kind.parameters:
            if found.setdefault(parameter.name, parameter) != parameter:
                raise ValueError(f"{parameter.name} of the law {law} differs from that of {laws[parameter.name][0]}")
            laws.setdefault(parameter.name, []).append(law)
    return tuple(parameter if len(laws[name]) == len(registry)
                 else replace(parameter, when={**(parameter.when or {}), choice: tuple(laws[name])})
                 for name, parameter in found.items())
