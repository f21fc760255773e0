# GPL v2 or later, see LICENSE.
"""What a scene says of its samples and loads beside bodies and engines, so that they are known again after loading:
JSON in ``O.tags``, which YADE saves with the scene.

The tags are "ddem sample", "ddem bending" and "ddem direct shear".
"""
import json

import numpy as np

from yade import O

_TAG = "ddem "


def add(kind, bodies, **numbers):
	"""Note numbers (what JSON takes) of something that consists of some bodies; what was noted of any of these
	bodies before is forgotten."""
	others = [note for note in _notes(kind) if not {*note["bodies"]} & {*bodies}]
	_write(kind, [*others, {"bodies": [int(i) for i in bodies], **numbers}])


def only(kind, shapes):
	"""The note whose bodies are there, of these shapes.

	:param shapes: class of the shape of each of the bodies
	:raises RuntimeError: there is none, or more than one
	"""
	found = [
		note for note in _notes(kind) if all(
			i < len(O.bodies) and O.bodies[i] and isinstance(O.bodies[i].shape, shape)
			for i, shape in zip(note["bodies"], shapes)
		)
	]
	if len(found) != 1:
		raise RuntimeError(
			f"the scene has {len(found)} loads that it says are a {kind}, where one is asked for; one that "
			"an older version saved does not say so: set it up anew"
		)
	return found[0]


def add_sample(ids, lower, upper, shape):
	"""Note a sample of spheres; where there is another one already, that there are several: which sphere is of
	which sample is not kept.

	:param ids: of its spheres
	:param lower, upper: corners of its box [m]
	:param shape: one of :mod:`shapes`, or None where its box stands for it
	"""
	# the first body of a scene: what was noted is of bodies that are gone
	before = sample() if min(ids) > 0 else None
	if before and (before["count"] > 1 or any(O.bodies[i] for i in _listed(before["runs"]) if i < len(O.bodies))):
		_write("sample", {"count": before["count"] + 1})
		return
	_write(
		"sample", {
			"count": 1, "runs": _runs(ids), "lower": np.asarray(lower).tolist(),
			"upper": np.asarray(upper).tolist(),
			"shape": shape and shape.as_record()
		}
	)


def sample(ids=None):
	"""What was noted of the scene's sample: "count" of samples, and where that is one, "lower", "upper" and the
	record of "shape". None where nothing was.

	:param ids: the spheres that are to be it; where others are among them, nothing was noted
	"""
	note = _notes("sample") or None
	if note and ids is not None and note["count"] == 1 and not {*map(int, ids)} <= {*_listed(note["runs"])}:
		return None
	return note


def _notes(kind):
	return json.loads(O.tags[_TAG + kind]) if O.tags.has_key(_TAG + kind) else []


def _write(kind, notes):
	O.tags[_TAG + kind] = json.dumps(notes)


def _runs(ids):
	"""First and last (n, 2) of the runs of consecutive numbers among some ids."""
	ids = np.unique(np.asarray(ids, int))
	breaks = np.flatnonzero(np.diff(ids) > 1)
	return np.column_stack([ids[[0, *(breaks + 1)]], ids[[*breaks, len(ids) - 1]]]).tolist()


def _listed(runs):
	return (i for first, last in runs for i in range(first, last + 1))
