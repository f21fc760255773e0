# GPL v2 or later, see LICENSE.
"""Loading a sample: platens that compress it, and runs with a progress bar."""
import math
import numbers
import sys
import time

import numpy as np

from yade import DeformableEngine, DeformableTriangle, O, RampedTranslationEngine, ServoPlaten

from . import meter
from .block import Block
from .edge_loads import absorb, pressure


def platens(block, velocity, ramp=0.0, lateral="fixed", both=False, top="top", bottom="bottom"):
	"""Drive the top of a block down (and the bottom up), as stiff platens would.

	:param block: :class:`Block` from :func:`block.append`
	:param velocity: speed of the top platen [m/s], positive compresses, negative pulls.
	:param ramp: time over which the speed grows linearly from zero [s].
	:param lateral: "fixed" holds the end nodes laterally (rough platens), "free" lets them slide.
	:param both: False: the bottom stands still; True: it moves towards the top at the same speed.
	:param top, bottom: the nodes that the platens hold, as :meth:`Block.boundary` takes them. A sample without flat
		ends, such as a disc, needs functions of the mesh's coordinates, for example ``top=lambda x, y: y >
		0.0245``.
	:returns: :class:`Platens`; put its ``engines`` into O.engines before the DeformableEngine.
	:raises ValueError: velocity, ramp or lateral out of range; an end that is no side of the sample (see
		:meth:`mesh.Mesh.boundary`), has no border edge between its nodes, or does not lie where it should.
		Nothing is held then.
	"""
	if lateral not in ("fixed", "free"):
		raise ValueError(
			f"lateral = '{lateral}' is unknown; use 'fixed' (rough platens) or 'free' (smooth platens)"
		)
	if not math.isfinite(velocity) or velocity == 0:
		raise ValueError(f"velocity = {velocity} m/s must be a number other than zero")
	if not ramp >= 0:
		raise ValueError(f"ramp = {ramp} s must not be negative")
	return Platens(block, velocity, ramp, lateral, both, top, bottom)


class Platens:
	"""Two platens on a block of deformable triangles: what they do and what they feel.
	Compression is positive here, as strengths are."""

	def __init__(self, block, velocity, ramp, lateral, both, top="top", bottom="bottom"):
		mesh = block.mesh
		self._measure(block, {"top": mesh.boundary(top), "bottom": mesh.boundary(bottom)})
		dofs = "xy" if lateral == "fixed" else "y"
		for ids in (self.top, self.bottom):
			block.hold(ids, dofs)
		self.engines = [_drive(self.top, -velocity, ramp)]
		if both:
			self.engines.append(_drive(self.bottom, velocity, ramp))

	@classmethod
	def from_scene(cls, block):
		"""The platens on a block of the current scene, for a scene that was loaded.

		:param block: as from :meth:`block.Block.from_scene`
		:raises RuntimeError: no RampedTranslationEngine drives nodes of the block along y, or none of its nodes
			is held at the other end
		"""
		mine = set(block.node_ids.tolist())
		drives = [
			e for e in O.engines
			if isinstance(e, RampedTranslationEngine) and abs(e.translationAxis[1]) == 1 and e.ids
			and mine.issuperset(e.ids)
		]
		level = lambda e: np.mean([O.bodies[i].state.refPos[1] for i in e.ids])
		drives.sort(key=level)
		if not drives:
			raise RuntimeError(
				"no RampedTranslationEngine in O.engines drives nodes of this block along y: "
				"there are no platens"
			)
		rows = {i: row for row, i in enumerate(block.node_ids.tolist())}
		top = sorted(rows[i] for i in drives[-1].ids)
		if len(drives) > 1:
			bottom = sorted(rows[i] for i in drives[0].ids)
		else:
			middle = block.mesh.nodes[:, 1].mean()
			bottom = [
				row for row in block.mesh.boundary().tolist()
				if block.mesh.nodes[row, 1] < middle and row not in set(top)
				and "y" in O.bodies[block.node_ids[row]].state.blockedDOFs
			]
		if not bottom:
			raise RuntimeError("no node of this block is held at the end that the platens do not drive")
		self = cls.__new__(cls)
		self._measure(block, {"top": np.array(top), "bottom": np.array(bottom)})
		self.engines = drives[::-1]
		return self

	def _measure(self, block, rows):
		"""Areas and length of a block between its ends."""
		self.sample = block
		self._rows, mesh = rows, block.mesh
		shared = np.intersect1d(*self._rows.values())
		if len(shared):
			x, y = mesh.nodes[shared[0]]
			raise ValueError(
				f"platens: {len(shared)} nodes, such as the one at ({x:.6g}, {y:.6g}) m, belong to "
				"both ends; top= and bottom= must name different nodes"
			)
		widths = {name: _loaded_width(mesh, name, rows) for name, rows in self._rows.items()}
		upper = _level(mesh.nodes[self._rows["top"], 1], np.max)
		lower = _level(mesh.nodes[self._rows["bottom"], 1], np.min)
		self.height = upper - lower  #: gauge length: distance of the mean levels of both ends at the start [m]
		if not self.height > 0:
			raise ValueError(
				f"platens: the top lies at y = {upper:.6g} m, not above the bottom at {lower:.6g} m; "
				"exchange top= and bottom="
			)
		self.area = widths["top"] * block.thickness  #: loaded area of the top, seen along the load [m²]
		self.area_bottom = widths["bottom"] * block.thickness  #: that of the bottom [m²]
		self.top, self.bottom = (block.node_ids[self._rows[name]] for name in ("top", "bottom"))  #: body ids

	@property
	def force_top(self):
		"""Force that compresses the sample at the top [N], compression positive."""
		return float(self.sample.node_forces[self._rows["top"], 1].sum())

	@property
	def force_bottom(self):
		"""Force that compresses the sample at the bottom [N], compression positive."""
		return float(-self.sample.node_forces[self._rows["bottom"], 1].sum())

	@property
	def stress_top(self):
		"""Average normal stress on the top [Pa], compression positive."""
		return self.force_top / self.area

	@property
	def stress(self):
		"""Mean normal stress of both ends [Pa], compression positive: (F_top/A_top + F_bottom/A_bottom)/2."""
		return 0.5 * (self.force_top + self.force_bottom * (self.area / self.area_bottom)) / self.area

	@property
	def strain(self):
		"""Shortening of the sample over its ``height`` [-], compression positive: of the distance between
		the means of both ends.
		"""
		moved = self.sample.displacements
		return float(moved[self._rows["bottom"], 1].mean() - moved[self._rows["top"], 1].mean()) / self.height


def servo(block, legs, velocity, lateral="free", failure=0.0, top="top", bottom="bottom"):
	"""A platen that loads a block by stresses and strains; the bottom stands still::

		press = ddem.servo(block, [("stress", 20e6, 1e-3), ("stress", 2e6, 1e-3), ("strain", 4e-3, 2e-3)],
		velocity=0.5) O.engines = [ForceResetter(), *press.engines, DeformableEngine()]

	:param block: :class:`Block` from :func:`block.append`
	:param legs: each ("stress", target [Pa], duration [s]) or ("strain", target [-], duration [s]), compression
		positive; strain counts from the start, of the distance between both ends. A leg goes from what it finds
		to its target and begins and ends without a jolt.
	:param velocity: largest speed in legs to a stress [m/s].
	:param lateral: "free" lets the end nodes slide (smooth platens), "fixed" holds them (rough platens).
	:param failure: share of the stress asked for below which a platen that runs at its largest speed stops for
		good, ``press.failed``; 0: never.
	:param top, bottom: as for :func:`platens`.
	:returns: :class:`ServoPlatens`; put its ``engines`` into O.engines.
	:raises ValueError: legs that are none, lateral, velocity or failure out of range; ends as for :func:`platens`.
		Nothing is held then.
	"""
	if lateral not in ("fixed", "free"):
		raise ValueError(
			f"lateral = '{lateral}' is unknown; use 'fixed' (rough platens) or 'free' (smooth platens)"
		)
	legs = checked_legs(legs)
	return ServoPlatens(block, legs, velocity, lateral, failure, top, bottom)


def checked_legs(legs):
	"""Legs of a course of stresses and strains as a list of tuples.

	:raises ValueError: naming the leg that is none
	"""
	legs = [tuple(leg) for leg in legs]
	for leg in legs:
		if len(leg) != 3 or leg[0] not in ("stress", "strain"):
			raise ValueError(
				f"servo: the leg {leg} must be ('stress', target [Pa], duration [s]) or ('strain', "
				"target [-], duration [s])"
			)
	if not legs:
		raise ValueError("servo: legs is empty; give at least one, such as ('stress', 10e6, 1e-3)")
	return legs


class ServoPlatens(Platens):
	"""Platens of which the top one follows a table of stresses and strains; see :func:`servo`."""

	def __init__(self, block, legs, velocity, lateral, failure, top="top", bottom="bottom"):
		mesh = block.mesh
		self._measure(block, {"top": mesh.boundary(top), "bottom": mesh.boundary(bottom)})
		kinds = ["force" if kind == "stress" else "displacement" for kind, _, _ in legs]
		scale = {"stress": self.area, "strain": self.height}
		self.platen = ServoPlaten(  # refuses what is out of range, before anything is held
			ids=[int(i) for i in self.top], direction=(0, -1, 0), kinds=kinds,
			targets=[target * scale[kind] for kind, target, _ in legs], durations=[d for _, _, d in legs],
			velocity=velocity, failure=failure, dashpot=self._impedance() * self.area
		)
		dofs = "xy" if lateral == "fixed" else "y"
		for ids in (self.top, self.bottom):
			block.hold(ids, dofs)
		self.engines = [self.platen]

	def _impedance(self):
		"""Mean ρ c_p [Pa·s/m] of the triangles at the top, so that their waves do not come
		back from the platen."""
		held = np.isin(self.sample.mesh.triangles, self._rows["top"]).any(axis=1)
		values = []
		for i in self.sample.triangle_ids[held]:
			material = O.bodies[i].material
			values.append(math.sqrt(material.density * (material.bulk + 4 / 3 * material.shear)))
		return float(np.mean(values))

	@property
	def failed(self):
		"""Whether the sample has given way, and the platen stands still."""
		return self.platen.failed

	@property
	def done(self):
		"""Whether all legs are done."""
		return self.platen.done


def _loaded_width(mesh, name, rows):
	"""Width [m] of the border between these nodes as the load sees it: gaps such as the mouth of a notch do not
	count.
	"""
	edges = mesh.border_between(rows)
	alone = np.setdiff1d(rows, edges)
	if len(alone):
		x, y = mesh.nodes[alone[0]]
		raise ValueError(
			f"platens: {name}= finds {len(rows)} node{'s' * (len(rows) > 1)}, and no edge of the border "
			f"joins the one at ({x:.6g}, {y:.6g}) m with another of them: "
			f"it has no loaded area, so there is no stress; let the function of {name}= name whole edges, "
			"for example all border nodes within a few edge lengths of it"
		)
	left, right = np.array(sorted(sorted(ends) for ends in mesh.nodes[edges, 0].tolist())).T
	reach = np.maximum.accumulate(right)
	gaps = np.flatnonzero(left[1:] > reach[:-1])
	width = float(sum(reach[[*gaps, -1]] - left[[0, *(gaps + 1)]]))
	if not width > 0:
		raise ValueError(
			f"platens: the border edges of {name}= are all along the load, x = {left[0]:.6g} m: they have "
			"no loaded area; name edges across the load"
		)
	return width


def _level(heights, outermost):
	"""Mean of the heights [m]; exactly theirs where they are the same."""
	reference = outermost(heights)
	return float(reference + (heights - reference).mean())


def _drive(ids, velocity, ramp):
	return RampedTranslationEngine(ids=ids, translationAxis=(0, 1, 0), velocity=velocity, rampTime=ramp)


def run(until=None, steps=None, progress=True):
	"""O.run with a progress bar and checks beforehand; plain O.run works as well. The time step may change on the
	way (:yref:`DeformableTimeStepper`).

	A run that something else ends, such as O.pause() in a PyRunner, ends here as well. With the progress bar a line
	at the end says what the steps cost: nanoseconds of processor time a particle and step, of all threads together;
	where a :class:`meter.StepMeter` counts them, that says it.

	:param until: time to run to [s]; or
	:param steps: number of steps.
	:raises ValueError: neither or both of them, a time that has passed, no time step.
	:raises RuntimeError: an engine is missing or the run stopped with an error; bad input shows in the first step,
		and may be a ValueError.
	"""
	from tqdm import tqdm
	if (until is None) == (steps is None):
		raise ValueError("give either until= [s] or steps=")
	if not O.dt > 0:
		raise ValueError(f"O.dt = {O.dt} s must be positive; set O.dt = ddem.time_step(0.8)")
	if steps is None:
		if not O.time <= until < math.inf:
			raise ValueError(
				f"until = {until} s must not lie before the present time, {O.time} s; for a number of "
				"steps give steps="
			)
	elif not (isinstance(steps, numbers.Integral) and steps >= 0):
		raise ValueError(f"steps = {steps!r} must be a whole number, 0 or more")
	_require_engine()
	first, piece = O.iter, 1
	left = lambda: first + steps - O.iter if until is None else math.ceil((until - O.time) / O.dt - 1e-9)
	busy = time.process_time()
	with tqdm(total=left(), unit="step", disable=None if progress else True) as bar:
		count = 0 if bar.disable else meter.particles()
		while left() > 0:
			bar.total = O.iter - first + left()
			begin, target, clock = O.iter, O.iter + min(piece, left()), time.perf_counter()
			spent = time.process_time()
			if piece == 1:
				O.step()  # O.run would miss an error that comes before it starts to wait
			else:
				O.run(target - begin, True)
			if not bar.disable:
				took = time.process_time() - spent
				bar.set_postfix_str(
					meter.refined(count, O.iter - begin, took, left(), spent - busy), refresh=False
				)
			bar.update(O.iter - begin)
			if O.iter < target:
				break  # paused
			# O.run looks for its end only every 40 ms, so pieces are long: half a second, which is also how
			# often the bar moves and Ctrl-C is heard
			piece = max(1, round(piece * min(10, 0.5 / (time.perf_counter() - clock))))
	if progress and O.iter > first and not meter.is_metered():
		print(meter.told(O.iter - first, time.process_time() - busy), file=sys.stderr)


def _require_engine():
	if any(isinstance(e, DeformableEngine) for e in O.engines):
		return
	if any(isinstance(b.shape, DeformableTriangle) for b in O.bodies if b):
		raise RuntimeError(
			"O.engines has no DeformableEngine, so the deformable triangles would not move; "
			"add DeformableEngine() after the engines that add forces"
		)
