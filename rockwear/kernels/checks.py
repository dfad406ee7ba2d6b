"""One form of error for every parameter: name, value, unit and the rule it breaks, in one line."""
import math
from contextlib import contextmanager


class ParameterError(ValueError):
    """A parameter broke its rule. str() is one line: ``kn = -1 N/m: must be greater than 0``."""

    def __init__(self, name, value, rule, unit=""):
        self.name, self.value, self.rule, self.unit = name, value, rule, unit
        shown = f"{value:g}" if isinstance(value, float) else str(value)
        super().__init__(f"{name} = {shown}{' ' + unit if unit else ''}: must be {rule}")


def require(condition, name, value, rule, unit=""):
    """Raise ParameterError unless `condition` holds."""
    if not condition:
        raise ParameterError(name, value, rule, unit)


def finite(name, value, unit=""):
    """`value` as a finite float, or ParameterError."""
    try:
        number = float(value)
    except (TypeError, ValueError):
        raise ParameterError(name, value, "a number", unit) from None
    except OverflowError:
        # An integer of more digits than a float can have.
        number = math.inf
    require(math.isfinite(number), name, number, "finite", unit)
    return number


def positive(name, value, unit=""):
    """`value` as a finite float greater than 0, or ParameterError."""
    number = finite(name, value, unit)
    require(number > 0, name, number, "greater than 0", unit)
    return number


def not_negative(name, value, unit=""):
    """`value` as a finite float of at least 0, or ParameterError."""
    number = finite(name, value, unit)
    require(number >= 0, name, number, "at least 0", unit)
    return number


def within(name, value, low, high, unit=""):
    """`value` as a finite float in [low, high], or ParameterError."""
    number = finite(name, value, unit)
    require(low <= number <= high, name, number, f"between {low:g} and {high:g}", unit)
    return number


@contextmanager
def known_as(**names):
    """A context in which ParameterErrors of `word` are of names[word]: a kernel's words under those of the user."""
    try:
        yield
    except ParameterError as error:
        raise ParameterError(names.get(error.name, error.name), error.value, error.rule, error.unit) from None
