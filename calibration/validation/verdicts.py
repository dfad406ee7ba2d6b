"""Results of a validation: rows of expected and found values with a verdict, in sections."""
from dataclasses import dataclass, field
from typing import Callable


@dataclass
class Row:
    """One quantity; it may deviate by up to `allowed` (in the quantity's unit).

    source: the expected value is published of another rock or model; a deviation is no failure.
    """

    quantity: str
    expected: float
    found: float
    allowed: float
    unit: str = ""
    source: bool = False

    @property
    def verdict(self):
        """holds or FAILS; agrees or differs from a source."""
        close = abs(self.found - self.expected) <= self.allowed
        return {(True, False): "holds", (False, False): "FAILS", (True, True): "agrees", (False, True): "differs"}[
            close, self.source]

    def cells(self):
        """The row of the printed table."""
        unit = f" {self.unit}" if self.unit else ""
        return [self.quantity, f"{self.expected:g}{unit}", f"{self.found:.6g}{unit}",
                f"{self.found - self.expected:+.2g}", f"{self.allowed:.2g}", self.verdict]


@dataclass
class Section:
    """runs: {name: (script, {parameter: value})}; evaluate({name: RunFolder}) -> (rows, {name: Figure})."""

    title: str
    words: str
    evaluate: Callable
    runs: dict = field(default_factory=dict)
