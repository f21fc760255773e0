# GPL v2 or later, see LICENSE.
"""What the steps of YADE cost while something runs them: O.run, O.step, and whatever calls them."""
import contextlib
import resource
import time

from yade import DeformableEngine, O, Sphere


def particles():
	"""How many particles the scene has: triangles, or spheres where it has none."""
	engines = _engines()
	if engines:
		return sum(len(engine.values("triangleIds")) for engine in engines)
	return sum(1 for body in O.bodies if body and isinstance(body.shape, Sphere))


def unknowns():
	"""Degrees of freedom of the particles: two of a node, two or three of a core, six of a sphere; held ones
	included."""
	engines = _engines()
	if not engines:
		return 6 * particles()
	of_core = lambda engine: 3 if engine.rotation == "cosserat" else 2
	return sum(
		2 * len(engine.values("nodeIds")) + of_core(engine) * len(engine.values("triangleIds"))
		for engine in engines
	)


def nanoseconds(value):
	"""As "9.87 ns" or "1234 ns"."""
	return f"{value:.3g} ns" if value < 100 else f"{value:.0f} ns"


def told(steps, cpu_s):
	"""What so many steps have cost, in a line: "1200 steps of 10070 triangles: 21 ns a triangle-step, 0.25 s of
	processor time"."""
	count, kind = particles(), "triangle" if _engines() else "sphere"
	share = f"{nanoseconds(1e9 * cpu_s / (steps * count))} a {kind}-step, " if steps and count else ""
	return f"{steps} steps of {count} {kind}s: {share}{cpu_s:.3g} s of processor time"


def refined(count, steps, cpu_s, left, spent):
	"""What a run takes in all, by its last steps: "21 ns a triangle-step, 14 core-seconds in all"; nothing where it
	made none.

	:param count: of particles, whose counting takes time
	:param steps: number of the last steps, and *cpu_s* their processor time [s]
	:param left: steps that are still to come
	:param spent: processor time before those [s]
	"""
	if not (steps and count):
		return ""
	kind = "triangle" if _engines() else "sphere"
	total = spent + cpu_s * (1 + left / steps)
	return f"{nanoseconds(1e9 * cpu_s / (steps * count))} a {kind}-step, {total:.2g} core-seconds in all"


def memory():
	"""Memory of this process that is resident now [bytes]."""
	with open("/proc/self/statm") as file:
		return int(file.read().split()[1]) * resource.getpagesize()


def _engines():
	return [engine for engine in O.engines if isinstance(engine, DeformableEngine)]


_waited = 0.0  # how long recorders have waited for the processor since the program began [s]


def _now():
	"""Processor time of all threads, of this thread, and time by the clock [s]."""
	return time.process_time(), time.thread_time(), time.perf_counter()


@contextlib.contextmanager
def recording():
	"""What an engine does that a :class:`StepMeter` leaves out. YADE times engines by the clock, which on a busy
	machine goes on while they wait for the processor; this notes how long."""
	global _waited
	_, busy, clock = _now()
	try:
		yield
	finally:
		_, busy_then, clock_then = _now()
		_waited += max(0.0, clock_then - clock - (busy_then - busy))


class StepMeter:
	"""Counts steps and their time, of all threads together and by the clock, while it is entered::

		with ddem.StepMeter() as meter:
			anything()
		print(meter.ns_per_particle_step)

	What happens between the runs, as making a mesh or a picture, does not count. A run in the background counts
	until O.wait(). Meters must not be nested.

	:param apart: labels of engines whose time does not count either, where O.timingEnabled says it: what records.
		What they do is to be within :func:`recording`; else a busy machine makes steps look too cheap.
	"""

	def __init__(self, apart=()):
		self.apart = set(apart)
		self.steps, self.particle_steps = 0, 0
		self.cpu_s, self.wall_s = 0.0, 0.0  #: [s]
		self.particles, self.unknowns, self.dt = 0, 0, 0.0  #: of the largest scene, and its time step [s]
		self._began = None

	def __enter__(self):
		self._plain = {name: getattr(O, name) for name in ("run", "step", "wait")}
		# attributes of the one Omega that all modules share hide its methods
		O.run, O.step, O.wait = self._run, self._step, self._wait
		return self

	def __exit__(self, *_):
		for name in self._plain:
			delattr(O, name)

	@property
	def ns_per_particle_step(self):
		"""Processor time of a step over the particles [ns]."""
		return 1e9 * self.cpu_s / self.particle_steps if self.particle_steps else float("nan")

	def _of_others(self):
		return sum(1e-9 * engine.execTime for engine in O.engines if engine.label in self.apart)

	def _begin(self):
		if self._began is None:
			busy, _, clock = _now()
			self._began = (O.iter, busy, clock, self._of_others(), _waited)

	def _end(self):
		if self._began is None:
			return
		first, busy, clock, before, waited = self._began
		busy_then, _, clock_then = _now()
		self._began, others = None, self._of_others()
		others -= before if others >= before else 0  # where YADE's timing began anew
		busy = max(0.0, busy_then - busy - max(0.0, others - (_waited - waited)))
		clock = max(0.0, clock_then - clock - others)
		steps = O.iter - first
		if steps <= 0:
			return
		count = particles()
		self.steps += steps
		self.particle_steps += steps * count
		self.cpu_s += busy
		self.wall_s += clock
		if count >= self.particles:
			self.particles, self.unknowns, self.dt = count, unknowns(), O.dt

	def _run(self, nSteps=-1, wait=False):
		self._begin()
		try:
			return self._plain["run"](nSteps, wait)
		finally:
			if wait:
				self._end()

	def _step(self):
		self._begin()
		try:
			return self._plain["step"]()
		finally:
			self._end()

	def _wait(self):
		try:
			return self._plain["wait"]()
		finally:
			self._end()
