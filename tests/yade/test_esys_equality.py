# GPL v2 or later, see LICENSE.
# Whole samples in the convention 'esys' against runs of ESyS-Particle 2.3.5 on the same samples
# (tests/data/esys/README.md).
import csv
import math
import os

import numpy as np
import pytest

from yade import BondedMat, O
from yade.ddem import bonded, packing
from yade.ddem.studies import measures

from recording import run_recording

DATA = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "data", "esys")
AREA = 1e-4  # of the loaded face [m²]

# ESyS-Particle takes angles from acos: near zero they are 0, 1.5e-8 or 2.1e-8 rad, and the shear forces ks r0 (γ - θ/2)
# noise of up to 3.2e-8 ks r0 (γ and half of θ). A particle gives way to that by about 3.2e-8 ks
# r0/kn = 3.2e-8 · 0.4 r0, 5e-8 mm for the largest pair (r0 = 4 mm); twice that where it vibrates.
ANGLE_NOISE = 1e-10  # [m]


def reference_runs():
	with open(os.path.join(DATA, "runs.csv"), newline="") as file:
		return {
			row["run"]: {
				name: value if name in ("run", "sample", "mass_law") else float(value)
				for name, value in row.items()
			}
			for row in csv.DictReader(file)
		}


RUNS = reference_runs()


def table(name):
	return np.genfromtxt(os.path.join(DATA, name), delimiter=",", names=True)


def scene(run):
	"""The sample between its walls, in ESyS-Particle's convention, masses and units of the reference
	run turned into SI."""
	O.reset()
	spheres = packing.read(
		*(os.path.join(DATA, f"sample_{run['sample']}_{part}.csv") for part in ("particles", "bonds")),
		length_unit="mm",
	)
	spheres.lower, spheres.upper = np.array([-5e-3, 0, -5e-3]), np.array([5e-3, 20e-3, 5e-3])
	density = {"cube": 1e6, "solid": 2600}[run["mass_law"]]
	O.materials.append(
		BondedMat(
			label="rock",
			density=density,
			cohesion=1e6 * run["cohesion_MPa"],
			bondFrictionAngle=math.atan(run["tan_phi"]),
		)
	)
	sample = bonded.append(spheres, "rock", mass_law=run["mass_law"])
	O.dt = 1e-3 * run["dt_ms"]
	platens = bonded.platens(
		sample, velocity=0.125, ramp=run["ramp_steps"] * O.dt, stiffness=1e6 * run["wall_stiffness_MPa"]
	)
	O.engines = bonded.engines(platens, viscosity=2, convention="esys")
	return sample, platens


def crush(run):
	"""Strain, stress [MPa] and number of broken bonds at every record of the reference run."""
	sample, platens = scene(run)
	period, records = int(run["record_period"]), []
	run_recording(
		int(run["steps"]),
		period,
		lambda: records.append((platens.strain, platens.stress / 1e6, bonded.law().brokenCount())),
	)
	return np.array(records).T


@pytest.fixture(autouse=True)
def clean_scene():
	yield
	O.reset()


@pytest.mark.parametrize("state, run", [("coarse_s1_D", "coarse_s1_D"), ("ref_s1_G", "ref_s1_F")])
def test_positions_follow_esys_to_its_angle_noise(state, run):
	sample, _ = scene(RUNS[run])
	for step in (1, 10, 100, 1000):
		O.run(step - O.iter, True)
		reference = table(f"state_{state}_step{step}.csv.gz")
		positions = 1e-3 * np.column_stack([reference[axis] for axis in "xyz"])
		assert np.abs(sample.positions - positions).max() < (1e-17 if step == 1 else ANGLE_NOISE)
	# bonds across gaps break in the second step
	assert bonded.law().brokenCount() == {"coarse_s1_D": 1, "ref_s1_F": 8}[run]


# Up to these parts of the strength stresses agree within 1e-3 MPa. In coarse_s1_D a bond breaks at 58 % one step apart,
# in ref_s1_R two at 50 %.
AGREEMENT = {"coarse_s1_D": 0.5, "ref_s1_R": 0.4}

# After a bond has broken one step apart runs differ for good, and the strength with them by chance. Most by far with
# the masses of rock, whose sample shakes: started from positions 1e-9 to 1.3e-7 mm beside those of the reference,
# eleven of our runs of ref_s1_R had 124.9 to 130.8 MPa, peaks at 0.00146 to 0.00164 and 5.8 to 12.7 % broken bonds;
# ESyS-Particle itself had 129.0 MPa with the walls at the spheres' box instead of 0 and 20 mm, and 131.2 MPa when
# positions were moved by up to 2e-8 mm as well. Relative tolerances of strength, Young's modulus (the fit ends at 60 %
# of the strength) and strain at the peak, and that of the broken share at the peak.
TOLERANCE = {"ref_s1_R": (0.05, 0.002, 0.15, 0.08), "ref_s1_B": (0.02, 0.003, 0.05, 0.03)}


@pytest.mark.parametrize(
	"name", [name if name == "coarse_s1_D" else pytest.param(name, marks=pytest.mark.slow) for name in RUNS]
)
def test_runs_agree_with_esys(name):
	run = RUNS[name]
	strain, stress, broken = crush(run)
	ours = measures.strength(strain, 1e6 * stress)

	reference = table(f"run_{name}.csv.gz")
	rows = (reference["step"] / run["record_period"]).astype(int) - 1
	esys = 1e-6 * (reference["bottom_Fy_N"] - reference["top_Fy_N"]) / (2 * AREA)
	before = rows < np.argmax(stress >= AGREEMENT.get(name, 0.6) * run["ucs_MPa"])
	assert before.sum() > 50
	assert np.abs(stress[rows] - esys)[before].max() < 1e-3
	assert np.array_equal(broken[rows][before], reference["bonds_broken"][before])

	strength, young, strain_at_peak, share = TOLERANCE.get(name, (0.01, 0.002, 0.05, 0.03))
	assert ours.ucs / 1e6 == pytest.approx(run["ucs_MPa"], rel=strength)
	assert ours.young / 1e9 == pytest.approx(run["young_GPa"], rel=young)
	assert ours.strain_at_peak == pytest.approx(run["strain_at_peak"], rel=strain_at_peak)
	assert broken[ours.peak] / run["bonds"] == pytest.approx(run["broken_at_peak"] / run["bonds"], abs=share)


def test_ours_is_not_esys():
	"""The convention matters: with full bending moments and rest lengths as built the same sample
	bears another stress."""
	stress = []
	for convention in ("esys", "consistent"):
		sample, platens = scene(RUNS["coarse_s1_D"])
		O.engines = bonded.engines(platens, viscosity=2, convention=convention)
		O.run(8000, True)
		stress.append(platens.stress)
	assert abs(stress[1] / stress[0] - 1) > 1e-3
