"""Tables of confined strengths: units, separators, and what is refused."""
import pytest

from calibration.laboratory import strength_table
from rockwear.kernels.checks import ParameterError


def read(folder, text, encoding="utf-8"):
    path = folder / "table.csv"
    path.write_text(text, encoding=encoding)
    return strength_table.read(path, "points")


@pytest.mark.parametrize("text", [
    "sigma1,sigma3\n5e7,0\n9e7,1e7\n", "\n sigma3 (MPa);sigma1 (mpa)\n\n0;50\n10;90\n",
    "sigma3_kPa\tsigma1_GPa\n0\t0.05\n1e4\t0.09\n", "rock,SIGMA3 [KPA],sigma2,Sigma1_peak_MPa\na,0,0,50\nb,1e4,0,90\n",
    "sigma_3/Pa;\u03c31, peak (GPa)\n0;0.05\n1e7;0.09\n"])
@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig"])
def test_units_and_separators(text, encoding, tmp_path):
    assert read(tmp_path, text, encoding) == [(0.0, pytest.approx(5e7)), (pytest.approx(1e7), pytest.approx(9e7))]


@pytest.mark.parametrize("head", ["sigma1_psi", "sigma1 (bar)", "sigma1 [N/mm2]", "sigma1 (xyz)", "sigma1/kgf",
                                  "sigma1_MPa_kPa", "sigma1 (kN/m2)"])
def test_other_units_are_refused(head, tmp_path):
    with pytest.raises(ParameterError) as caught:
        read(tmp_path, f"sigma3_MPa,{head}\n0,50\n")
    assert str(caught.value).endswith(f"table.csv, column {head}: must be a stress in Pa, kPa, MPa or GPa")


@pytest.mark.parametrize("text, error", [
    ("", "must be a table with one column sigma3"), ("sigma3\n1\n", "must be a table with one column sigma1"),
    ("sigma3,sigma3_MPa,sigma1\n", "must be a table with one column sigma3"),
    ("sigma3,sigma1\n", "must be a table with at least one row"),
    ("sigma3;sigma1\n\n1e6;6,1e7\n", "unlike line 3: 1e6,6,1e7"), ("sigma3,sigma1\n1e6,a\n", "unlike line 2: 1e6,a"),
    ("sigma3,sigma1\n1e6\n", "unlike line 2: 1e6"), ("sigma3,sigma1\n-1e6,6e7\n", "unlike line 2"),
    ("sigma3,sigma1\n10,100\n", "unlike line 2: 10,100"), ("sigma3,sigma1_GPa\n0,60\n", "unlike line 2")])
def test_a_bad_table_is_refused(text, error, tmp_path):
    with pytest.raises(ParameterError) as caught:
        read(tmp_path, text)
    assert error in str(caught.value) and "\n" not in str(caught.value) and str(caught.value).startswith("points = ")


def test_a_file_that_is_no_text_is_refused(tmp_path):
    with pytest.raises(ParameterError, match="must be a readable CSV file"):
        read(tmp_path, "sigma3,sigma1\n0,5e7\n", encoding="utf-16")
