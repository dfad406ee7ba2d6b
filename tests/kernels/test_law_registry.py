"""Laws declare their parameters: a new law is one class in one file, and nothing else changes."""
import shutil
import subprocess
import sys

import pytest

from rockwear.kernels.bond_laws import BOND_LAWS
from rockwear.kernels.bond_laws.base import KN, KT, MU, BondLaw
from rockwear.kernels.parameter import Parameter, above_zero, law_parameters
from rockwear.kernels.wear_laws import WEAR_LAWS
from tests.running import ROOT

NEW_BOND_LAW = '''
from rockwear.kernels.bond_laws.base import KN, KT, MU, RN, RT, LinearBondLaw
from rockwear.kernels.parameter import Parameter, above_zero


class Rubber(LinearBondLaw):
    """A bond that only a temperature melts."""

    name = "rubber"
    parameters = (KN, KT, RN, RT, MU, Parameter("rubber_melting", 400.0, "K", above_zero, "melts"))

    def _bonded(self, bond, un, ut):
        return self.kn * un, self._shear(bond, 0.0, ut)
'''
NEW_WEAR_LAW = '''
from rockwear.kernels.wear_laws.base import SingleMode
from rockwear.kernels.parameter import Parameter, above_zero


class Polish(SingleMode):
    """Wear that no load changes."""

    name = "polish"
    parameters = (Parameter("polish_rate", 1e-9, "", above_zero, "dw/ds"),)

    @classmethod
    def from_values(cls, values, mu):
        return cls(k=values["polish_rate"])
'''


@pytest.fixture
def registry():
    """BOND_LAWS, which a test may add to."""
    before = dict(BOND_LAWS)
    yield BOND_LAWS
    BOND_LAWS.clear()
    BOND_LAWS.update(before)


def test_the_laws_by_name():
    assert list(BOND_LAWS) == ["brittle", "damage", "plastic", "padova", "coulomb", "cohesive"]
    assert sorted(WEAR_LAWS) == ["dissipation", "modes", "power", "pressure"]


@pytest.mark.parametrize("package, text, law, parameter", [
    ("bond_laws", NEW_BOND_LAW, "rubber", "rubber_melting"), ("wear_laws", NEW_WEAR_LAW, "polish", "polish_rate")])
def test_a_new_file_in_the_package_is_a_new_law(package, text, law, parameter, tmp_path):
    (tmp_path / "rockwear").mkdir()
    shutil.copy(ROOT / "rockwear/__init__.py", tmp_path / "rockwear")
    shutil.copytree(ROOT / "rockwear/kernels", tmp_path / "rockwear/kernels")
    (tmp_path / f"rockwear/kernels/{package}/new_law.py").write_text(text, encoding="utf-8")
    program = (f"import rockwear.kernels.{package} as laws; from rockwear.kernels.parameter import law_parameters\n"
               f"registry = laws.{package.upper()}\n"
               f"found = {{p.name: p for p in law_parameters(registry, 'choice')}}\n"
               f"print('{law}' in registry, found['{parameter}'].when)")
    done = subprocess.run([sys.executable, "-c", program], cwd=tmp_path, capture_output=True, encoding="utf-8")
    assert done.stdout == f"True {{'choice': ('{law}',)}}\n", done.stderr


def test_a_class_with_a_name_is_registered_with_its_parameters(registry):
    own = Parameter("glue_age", 1.0, "s", above_zero, "age of the glue")

    class Glue(BondLaw):
        name = "glue"
        parameters = (KN, KT, MU, own)

    found = {parameter.name: parameter for parameter in law_parameters(registry, "bond_law")}
    assert registry["glue"] is Glue
    assert found["glue_age"].when == {"bond_law": ("glue",)} and found["glue_age"].default == 1.0
    assert found["kt"].when == {"bond_law": ("brittle", "damage", "plastic", "coulomb", "cohesive", "glue")}
    assert found["kn"].when is None and found["mu"].when is None
    assert found["Rn"].when == {"bond_law": ("brittle", "damage", "plastic", "padova")}


def test_two_laws_declare_a_name_alike(registry):
    class Glue(BondLaw):
        name = "glue"
        parameters = (Parameter("kn", 1.0, "N/m", above_zero, "another stiffness"),)

    with pytest.raises(ValueError, match="^kn of the law glue differs from that of brittle$"):
        law_parameters(registry, "bond_law")


@pytest.mark.parametrize("name", BOND_LAWS)
def test_every_bond_law_is_made_from_values(name):
    values = {parameter.name: parameter.default for parameter in law_parameters(BOND_LAWS, "bond_law")}
    law = BOND_LAWS[name].from_values({**values, "kn": 1e10})
    assert type(law) is BOND_LAWS[name] and law.name == name
    assert law.kn == 1e10 and law.mu == values["mu"] and law.kt > 0
    assert all(stiffest >= initial for stiffest, initial in zip(law.stiffest(), (law.kn, law.kt)))
