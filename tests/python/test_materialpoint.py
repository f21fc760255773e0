# GPL v2 or later, see LICENSE.
"""The material point's Python face: strengths, paths, effects, errors, use outside YADE."""
import os
import subprocess
from types import SimpleNamespace

import ddem
import numpy as np
import pytest
from ddem.materialpoint import EFFECTS, MaterialPoint, concrete


# Peaks of the rate equations of Zubelewicz (2018), Tables 1 and 2, with the closures that the law documents, as SciPy
# integrates them: yade.ddem.verification.concrete_rates. The default step must be good enough for a user.
@pytest.mark.parametrize(
	"rate, until, confinement, strength", [
		(-1, -0.006, 0, -91.03e6),
		(-1, -0.006, 20e6, -174.19e6),
		(-1, -0.006, 40e6, -248.67e6),
		(-1, -0.007, 60e6, -317.03e6),
		(1e-3, 0.003, 0, 5.945e6),
		(1e-1, 0.003, 0, 8.488e6),
		(1, 0.003, 0, 10.087e6),
		(10, 0.003, 0, 11.920e6),
		(1e3, 0.003, 0, 16.259e6),
	]
)
def test_uniaxial_strength(rate, until, confinement, strength):
	result = MaterialPoint().uniaxial(rate=rate, until=until, confinement=confinement)
	assert result.peak.stress == pytest.approx(strength, rel=5e-4)
	assert np.abs(result.stress[:, [0, 2]] + confinement).max() < 1
	assert result.axial_strain[-1] == pytest.approx(until)


@pytest.mark.parametrize("rate, until, strength", [(-1, -0.003, -53.53e6), (1, 0.003, 9.919e6)])
def test_plane_strain_strength(rate, until, strength):
	result = MaterialPoint().plane_strain(rate=rate, until=until)
	assert result.peak.stress == pytest.approx(strength, rel=5e-4)
	assert np.all(result.strain[:, 2] == 0)


@pytest.mark.parametrize("rate", (-1e-3, -1, -1e3))
def test_plane_strain_does_not_jump(rate):
	"""After the peak the lateral strain grows ten times as fast as the axial one; in steps that are too large for
	it the stress would jump by a tenth of the peak."""
	stress = MaterialPoint().plane_strain(rate=rate, until=-0.02).axial_stress
	assert np.abs(np.diff(stress)).max() < 1e-6 * 70e9  # no faster than the elastic slope, 62 GPa


def test_confinement_is_left_out_of_the_axial_strain():
	result = MaterialPoint().uniaxial(rate=-1, until=-0.006, confinement=40e6)
	assert result.peak.strain == pytest.approx(-0.00396, abs=2e-5)  # same source as the strengths
	assert result.axial_start == pytest.approx(-40e6 / (3 * 30e9), rel=0.15)  # the equation of state stiffens
	assert result.modulus_factor.max() > 1.1


def test_elastic_path_has_the_closed_form():
	point = MaterialPoint(effects=())
	result = point.path(duration=1, strain={"yy": 1e-3, "xy": 2e-3}, stress={"xx": 5e6}, steps=10)
	volume = result.strain[-1, :3].sum()
	assert result.stress[-1] == pytest.approx(
		(30e9 - 2 * 26e9 / 3) * volume * np.array([1, 1, 1, 0]) + 52e9 * result.strain[-1], abs=1
	)
	assert result.stress[-1, 0] == pytest.approx(5e6, abs=1)
	assert result.stored_energy[-1] == pytest.approx(
		0.5 * (result.stress[-1] * result.strain[-1] * [1, 1, 1, 2]).sum(), rel=1e-12
	)
	assert result.time[-1] == 1 and len(result.time) == 10


def test_cycles_run_on_from_the_present_state():
	cycled = MaterialPoint()
	whole = cycled.path(duration=0.005, strain={"yy": [0.002, -0.003, 0.001]}, stress={"xx": 0, "zz": 0}, every=10)
	parts = MaterialPoint()
	legs = [
		parts.path(duration=0.005, strain={"yy": target}, stress={"xx": 0, "zz": 0}, every=10)
		for target in (0.002, -0.003, 0.001)
	]
	for name in ("time", "stress", "strain", "damage", "stored_energy"):
		assert np.array_equal(getattr(whole, name), np.concatenate([getattr(leg, name) for leg in legs])), name
	assert np.array_equal(cycled.state.stress, parts.state.stress)


def test_energy_closes():
	result = MaterialPoint().path(duration=0.005, strain={"yy": [0.002, -0.003, 0.001]}, stress={"xx": 0, "zz": 0})
	stress, strain = (np.vstack([np.zeros(4), tensor]) for tensor in (result.stress, result.strain))
	work = (0.5 * (stress[1:] + stress[:-1]) * np.diff(strain, axis=0) * [1, 1, 1, 2]).sum(axis=1).cumsum()
	assert result.stored_energy + result.plastic_dissipation + result.damage_dissipation == pytest.approx(
		work, rel=1e-9, abs=1e-6
	)


def test_effects_are_chosen_by_name():
	assert np.all(MaterialPoint(effects={"viscoplasticFlow"}).uniaxial(rate=1, until=0.002).damage_ratio == 0)
	independent = set(EFFECTS) - {"rateDependence"}
	slow, fast = (
		MaterialPoint(effects=independent).uniaxial(rate=rate, until=0.002).peak.stress for rate in (1e-3, 1e3)
	)
	assert slow == pytest.approx(fast, rel=1e-6)
	assert np.all(
		MaterialPoint(effects=set(EFFECTS) - {"equationOfState"}).uniaxial(rate=-1, until=-0.002).modulus_factor
		== 1
	)


def test_preexisting_damage():
	cracked = MaterialPoint(damage=(0, 0.5, 0, 0)).uniaxial(rate=1, until=0.003)
	assert cracked.peak.stress < 0.9 * MaterialPoint().uniaxial(rate=1, until=0.003).peak.stress
	assert cracked.damage_ratio[0] == pytest.approx(0.25 / 1.25, abs=1e-3)


def test_any_object_with_the_attributes_will_do():
	assert MaterialPoint(SimpleNamespace(strength=100e6)).parameters == concrete(strength=100e6)
	assert MaterialPoint(dict(strength=100e6)).parameters == concrete(strength=100e6)


@pytest.mark.parametrize(
	"make, words", [
		(lambda: concrete(bluk=30e9), ["'bluk'", "did you mean 'bulk'"]),
		(lambda: concrete(bulk=-30e9), ["bulk modulus", "-3e+10 Pa"]),
		(lambda: concrete(strength=float("nan")), ["strength", "nan Pa"]),
		(lambda: concrete(strength="140 MPa"), ["strength", "'140 MPa'", "number"]),
		(lambda: concrete(friction=33), ["friction", "not an angle"]),
		(lambda: concrete(fractureEnergy=0), ["fractureEnergy", "J/m³", "per volume"]),
		(lambda: MaterialPoint(object()), ["none of the parameters"]),
		(lambda: MaterialPoint(effects={"flow"}), ["'flow'", "viscoplasticFlow"]),
		(lambda: MaterialPoint(effects="damage"), ["'damage'", "give a set"]),
		(lambda: MaterialPoint(damage=(1, 2, 3)), ["four components"]),
		(lambda: MaterialPoint(damage=(1, 0, 0, 2)), ["positive semi-definite"]),
		(lambda: MaterialPoint().uniaxial(rate=1, until=-0.01), ["same sign", "rate = 1.0 1/s"]),
		(lambda: MaterialPoint().uniaxial(rate=0, until=-0.01), ["same sign"]),
		(lambda: MaterialPoint().uniaxial(rate=1, until=float("inf")), ["finite", "until = inf"]),
		(
			lambda: MaterialPoint().uniaxial(rate=-1, until=-0.01, confinement=-1e6),
			["confinement", "-1000000.0 Pa"],
		),
		(lambda: MaterialPoint().uniaxial(rate=-1, until=-0.01, step=0), ["step"]),
		(lambda: MaterialPoint().path(duration=0, strain={"yy": 1e-3}), ["duration", "seconds"]),
		(lambda: MaterialPoint().path(duration=1, strain={"yz": 1e-3}), ["'yz'", "xx, yy, zz, xy"]),
		(lambda: MaterialPoint().path(duration=1, strain={"yy": 1e-3}, stress={"yy": 0}), ["'yy'", "both"]),
		(lambda: MaterialPoint().path(duration=1), ["give targets"]),
		(lambda: MaterialPoint().path(duration=1, strain={"yy": [1e-3, 0], "xx": [0, 0, 0]}), ["one length"]),
		(lambda: MaterialPoint().path(duration=1, strain={"yy": float("inf")}), ["not a finite number"]),
		(
			lambda: MaterialPoint().path(duration=1, strain={"yy": 1e-3}, steps=2.5),
			["steps = 2.5", "whole number"],
		),
	]
)
def test_bad_input_names_value_and_way_out(make, words):
	with pytest.raises(ValueError) as error:
		make()
	for word in words:
		assert word in str(error.value)


def test_too_much_stress_stops_where_the_material_gives_way():
	point = MaterialPoint()
	with pytest.raises(RuntimeError, match="yy"):
		point.path(duration=1, stress={"xx": 0, "yy": 50e6, "zz": 0})
	assert 8e6 < point.state.stress[0, 1] < 50e6
	assert np.isfinite(point.state.stress).all()


def test_works_without_yade():
	code = "\n".join((
		"import sys",
		# at the end: YADE has a math.py there
		f"sys.path.append({os.path.dirname(os.path.dirname(os.path.abspath(ddem.__file__)))!r})",
		"from ddem.materialpoint import MaterialPoint",
		"print(MaterialPoint().uniaxial(rate=-1, until=-0.004).peak.stress)",
		"assert 'yade' not in sys.modules",
	))
	run = subprocess.run(["python3", "-c", code], capture_output=True, text=True, check=False)
	assert run.returncode == 0, run.stderr
	assert float(run.stdout) == pytest.approx(-91.1e6, rel=0.01)
