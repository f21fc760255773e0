# GPL v2 or later, see LICENSE.
"""Dynamic relaxation: it ends at equilibrium, says how well forces balance, and leaves the scene as it was."""
import math

import numpy as np
import pytest

from yade import ForceEngine, O, Vector3, ddem

from deformable_samples import bodies, elastic, start


def hanging_column(*engines, **settings):
	"""A column held at the top."""
	block = ddem.append(ddem.mesh.rectangle(0.02, 0.05, size=0.01), elastic())
	block.hold(block.boundary("top"))
	return block, start(*engines, **settings)


@pytest.mark.parametrize("treatment", ("none", "cosserat"))
def test_supports_carry_the_weight_and_the_pull(treatment):
	block, engine = hanging_column(rotation=treatment, gravity=(0, -1e4, 0), damping=0.05)
	pulled = block.boundary("bottom")
	for i in pulled:
		O.forces.setPermF(int(i), (0, -1e3, 0))
	residual, steps = ddem.relax(1e-6)
	assert residual <= 1e-6 and steps == O.iter
	assert engine.damping == 0.05
	top = np.isin(block.node_ids, block.boundary("top"))
	free = sum(engine.array(kind + "Mass").sum() for kind in ("node", "core")) - engine.array("nodeMass")[top].sum()
	assert block.node_forces[top, 1].sum() == pytest.approx(-free * 1e4 - 1e3 * len(pulled), rel=1e-6)


def test_forces_of_other_engines_count():
	push = ForceEngine(force=(500, 0, 0))
	block, _ = hanging_column(push)
	push.ids = [int(i) for i in block.boundary("bottom")]
	ddem.relax(1e-5, damping=0.3)
	top = np.isin(block.node_ids, block.boundary("top"))
	assert block.node_forces[top, 0].sum() == pytest.approx(500 * len(push.ids), rel=1e-4)


def test_out_of_balance_is_the_largest_force_over_what_triangles_transmit():
	block, engine = hanging_column(rotation="none", gravity=(0, -1e4, 0))
	ddem.relax(1e-6)
	stress = block.stress
	norm = np.sqrt(stress[..., 0]**2 + stress[..., 1]**2 + 2 * stress[..., 3]**2).mean(axis=1)
	transmitted = (norm * np.sqrt(block.area)).mean()
	corner = int(block.boundary("bottom")[0])
	O.forces.setPermF(corner, (0.3 * transmitted, 0, 0))
	engine.damping = 0.4
	assert ddem.out_of_balance() == pytest.approx(0.3, rel=1e-4)
	assert engine.damping == 0.4


def test_a_sample_without_stress_or_load_is_in_balance():
	hanging_column()
	assert ddem.out_of_balance() == 0


def test_a_load_on_what_bears_nothing_yet_is_infinitely_out_of_balance():
	block, _ = hanging_column(gravity=(0, -10, 0))
	assert ddem.out_of_balance() == math.inf


def test_a_sample_that_flies_away_is_not_waited_for():
	block, engine = hanging_column(gravity=(0, -10, 0), damping=0.1)
	for body in bodies(block.node_ids):
		body.state.blockedDOFs = "zXYZ"
	for body in bodies(block.triangle_ids):
		body.state.pos += Vector3(1e-6, 0, 0)
	with pytest.raises(RuntimeError, match="out of balance by .* after .* steps, 1.0e-06 is wanted"):
		ddem.relax(1e-6, limit=2000)
	assert engine.damping == 0.1


@pytest.mark.parametrize(
	"settings, message", [({
	"residual": 0
	}, "residual = 0"), ({
	"damping": 1.0
	}, "damping = 1.0 must be positive and below 1"), ({
	"limit": -1
	}, "limit = -1")]
)
def test_bad_settings_are_named(settings, message):
	hanging_column()
	with pytest.raises(ValueError, match=message):
		ddem.relax(**settings)


def test_no_time_step():
	hanging_column()
	O.dt = 0
	with pytest.raises(ValueError, match="O.dt = 0"):
		ddem.relax()
