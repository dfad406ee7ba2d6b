"""What a validation finds: rows of expected and got with a verdict, and the sections they come in."""
from dataclasses import dataclass, field
from typing import Callable


@dataclass
class Row:
    """One quantity; a deviation of up to `allowed` (of the quantity's unit) is as good as none.

    source: the expected value is what a source says of its rock or model, and need not come out.
    """

    quantity: str
    expected: float
    got: float
    allowed: float
    unit: str = ""
    source: bool = False

    @property
    def verdict(self):
        """holds or FAILS; agrees or differs from a source."""
        close = abs(self.got - self.expected) <= self.allowed
        return {(True, False): "holds", (False, False): "FAILS", (True, True): "agrees", (False, True): "differs"}[
            close, self.source]

    def cells(self):
        """As the table shows it."""
        unit = f" {self.unit}" if self.unit else ""
        return [self.quantity, f"{self.expected:g}{unit}", f"{self.got:.6g}{unit}", f"{self.got - self.expected:+.2g}",
                f"{self.allowed:.2g}", self.verdict]


@dataclass
class Section:
    """runs: {name: (script, {parameter: value})}; judge({name: RunFolder}) -> (rows, {name: Figure})."""

    title: str
    words: str
    judge: Callable
    runs: dict = field(default_factory=dict)
