# GPL v2 or later, see LICENSE.
"""scripts/jacketed_cylinder.py: what it writes, what it refuses."""
import pytest
import script_modules

from yade.ddem.series import Series

SMALL = ["--rmin", "1e-3", "--strain", "2e-3", "--pressure", "5e6"]


def test_it_writes_a_curve_and_a_picture(monkeypatch, tmp_path, capsys):
	script_modules.run(script_modules.load("jacketed_cylinder"), monkeypatch, *SMALL, "--out", tmp_path / "new")
	assert {file.name for file in (tmp_path / "new").iterdir()} == {"curve.csv", "jacket.png"}
	curve = Series.read(tmp_path / "new" / "curve.csv")
	assert len(curve) == 100
	assert max(curve["stress"]) > 2 * 5e6 and max(curve["volumetric_strain"]) > 0
	assert str(tmp_path / "new") in capsys.readouterr().out


def test_it_refuses_a_pressure_that_pulls(monkeypatch, tmp_path, capsys):
	with pytest.raises(SystemExit) as error:
		script_modules.run(
			script_modules.load("jacketed_cylinder"), monkeypatch, "--pressure", "-1", "--out", tmp_path
		)
	assert error.value.code == 2
	assert "--pressure" in capsys.readouterr().err
