# GPL v2 or later, see LICENSE.
"""What the steps of YADE cost while something runs them, O.run, O.step, and whatever calls them; and what the particles
of a scene take in memory.

Two figures are the same everywhere, in tables, reports and files:

*ns_per_particle_step*
	Processor time of all threads within the steps, recorders left out, over steps and particles [ns]. Particles are
	triangles, or spheres where there are none; nodes and bonds are their particles'.
*bytes_per_particle*
	What the scene takes in memory, over its particles: see :func:`bytes_per_particle`.
"""
import contextlib
import ctypes
import functools
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
	"""What so many steps of the present scene have cost, in a line: "1200 steps of 10070 triangles: 21 ns a
	triangle-step, 0.25 s of processor time"."""
	count = particles()
	return line(kind(), steps, steps * count, cpu_s, count, count)


def line(kind, steps, particle_steps, cpu_s, least, most):
	"""The line of :func:`told`, of one scene or of several.

	:param kind: of the particles, as "triangle"
	:param particle_steps: sum over the steps of their particles
	:param cpu_s: processor time [s]
	:param least, most: particles of the smallest and of the largest scene
	"""
	share = f"{nanoseconds(1e9 * cpu_s / particle_steps)} a {kind}-step, " if particle_steps else ""
	count = f"{least}" if least == most else f"{least} to {most}"
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
	total = spent + cpu_s * (1 + left / steps)
	return f"{nanoseconds(1e9 * cpu_s / (steps * count))} a {kind()}-step, {total:.2g} core-seconds in all"


def kind():
	"""What a particle of the scene is: "triangle" or "sphere"."""
	return "triangle" if _engines() else "sphere"


def memory():
	"""Memory of this process that is resident now [bytes]."""
	with open("/proc/self/statm") as file:
		return int(file.read().split()[1]) * resource.getpagesize()


class _Mallinfo(ctypes.Structure):
	_fields_ = [
		(name, ctypes.c_size_t) for name in (
			"arena", "ordblks", "smblks", "hblks", "hblkhd", "usmblks", "fsmblks", "uordblks",
			"fordblks", "keepcost"
		)
	]


def heap():
	"""What is allocated in this process now [bytes], as malloc counts it: without what has been freed and not
	returned to the system, which the resident memory has."""
	count = ctypes.CDLL(None).mallinfo2
	count.restype = _Mallinfo
	found = count()
	return found.uordblks + found.hblkhd


_origin = None  # first body of the scene, and what was allocated before it [bytes]
_taken = None  # bytes a particle of that scene, once a step has been made


def makes_particles(append):
	"""Decorates a function that appends particles: where it puts the first ones into an empty scene, what
	:func:`bytes_per_particle` counts begins with it."""

	@functools.wraps(append)
	def appends(*arguments, **options):
		global _origin, _taken
		empty, before = len(O.bodies) == 0, heap()
		made = append(*arguments, **options)
		if empty:
			_origin, _taken = (O.bodies[0], before), None
		return made

	return appends


@contextlib.contextmanager
def beside_the_scene():
	"""What is allocated meanwhile, such as a state that is kept to be drawn, does not count as the scene's, see
	:func:`bytes_per_particle`."""
	global _origin
	before = heap()
	yield
	if _origin is not None:
		_origin = _origin[0], _origin[1] + heap() - before


def bytes_per_particle():
	"""What the scene takes in memory over its particles [bytes]: how much more is allocated than before ddem.append
	or ddem.bonded.append put the first body into the empty scene. That is bodies with state and shape, nodes,
	bonds, and the tables and fields of the engines. The state of the law alone is among the effects, see
	:mod:`effect_table`.

	Asked for after the first step it stays what it is then, so that what a run records does not count. None where
	there are no particles, or the scene was loaded or made by other means.

	Limits: whatever else the process has allocated or freed since then counts as well, such as an earlier scene
	that Python still held: a figure to rely on is that of a large scene, the first of its process.
	"""
	global _taken
	count = particles()
	# a body says where it lies; the one that is kept is no other's place
	if _origin is None or not count or str(O.bodies[0]) != str(_origin[0]):
		return None
	if _taken is None:
		found = max(0.0, (heap() - _origin[1]) / count)
		if not O.iter:
			return found
		_taken = found
	return _taken


def _engines():
	return [engine for engine in O.engines if isinstance(engine, DeformableEngine)]


def _now():
	"""Processor time of all threads, and time by the clock [s]."""
	return time.process_time(), time.perf_counter()


_beside = (0.0, 0.0)  # processor time and wall time of what has run beside the steps so far [s]


@contextlib.contextmanager
def beside_the_steps():
	"""What runs within steps meanwhile, as a record is taken, does not count as theirs."""
	global _beside
	busy, clock = _now()
	try:
		yield
	finally:
		busy_then, clock_then = _now()
		_beside = _beside[0] + busy_then - busy, _beside[1] + clock_then - clock


def time_beside():
	"""Processor time of all that has run in :func:`beside_the_steps` in this process [s]."""
	return _beside[0]


_entered = 0  # meters that are entered now


def is_metered():
	"""Whether a :class:`StepMeter` is entered, so that whoever entered it will say what steps cost."""
	return _entered > 0


class StepMeter:
	"""Counts steps and their time, of all threads together and by the clock, while it is entered::

		with ddem.StepMeter() as meter:
			anything()
		print(meter.ns_per_particle_step)
		print("\\n".join(meter.told()))

	What happens between the runs, as making a mesh or a picture, does not count. A run in the background counts
	until O.wait(). A meter may be entered while another one is; both count.

	:param apart: labels of engines that record: they are none of :attr:`engines`, and where they do not say
		themselves what they take (:func:`beside_the_steps`), O.timingEnabled says it
	"""

	def __init__(self, apart=()):
		self.apart = set(apart)
		self.steps, self.particle_steps = 0, 0
		self.cpu_s, self.wall_s = 0.0, 0.0  #: [s]
		self.particles, self.unknowns, self.dt = 0, 0, 0.0  #: of the largest scene, and its time step [s]
		self.bytes_per_particle = None  #: of the largest scene, see :func:`bytes_per_particle`
		#: wall time of each engine by its label or class [s] where O.timingEnabled says it, without those apart
		self.engines = {}
		self._kinds = {}  # kind of particle -> steps, particle-steps, processor time, least, most
		self._began, self._scene, self._count = None, None, (0, "")

	def __enter__(self):
		global _entered
		self._plain = {name: getattr(O, name) for name in ("run", "step", "wait")}
		self._before = {name: vars(O).get(name) for name in self._plain}
		# attributes of the one Omega that all modules share hide its methods
		O.run, O.step, O.wait = self._run, self._step, self._wait
		_entered += 1
		return self

	def __exit__(self, *_):
		global _entered
		_entered -= 1
		for name, before in self._before.items():
			delattr(O, name) if before is None else setattr(O, name, before)

	@property
	def ns_per_particle_step(self):
		"""Processor time of a step over the particles [ns]."""
		return 1e9 * self.cpu_s / self.particle_steps if self.particle_steps else float("nan")

	def figures(self):
		"""All of it as numbers, for files: cpu_s, wall_s, dt_s [s], steps, particle_steps, particles, unknowns,
		ns_per_particle_step; bytes_per_particle where it is known; engine:NAME of each engine, by the clock
		[ns a particle-step]. Empty where no step was made."""
		if not self.steps:
			return {}
		found = {
			"cpu_s": self.cpu_s, "wall_s": self.wall_s, "dt_s": self.dt, "steps": self.steps,
			"particle_steps": self.particle_steps, "particles": self.particles, "unknowns": self.unknowns,
			"ns_per_particle_step": self.ns_per_particle_step
		}
		if self.bytes_per_particle is not None:
			found["bytes_per_particle"] = self.bytes_per_particle
		found.update((f"engine:{name}", 1e9 * s / self.particle_steps) for name, s in self.engines.items())
		return found

	def told(self):
		"""What all steps have cost, a line for each kind of particle, as :func:`told` says it."""
		return [line(kind, *numbers) for kind, numbers in self._kinds.items()]

	def _begin(self):
		if self._began is None:
			self._began = (O.iter, _times(), _beside, *_now())

	def _end(self):
		if self._began is None:
			return
		now = _now()
		first, times, beside, busy, clock = self._began
		self._began, took = None, {}
		for name, after in _times().items():
			before = times.get(name, 0.0)
			took[name] = after - before if after >= before else after  # where YADE's timing began anew
		others = _beside[0] - beside[0], _beside[1] - beside[1]
		if not others[1]:
			# by the clock, which on a busy machine is more than the processor's
			others = (self._of_others(took), ) * 2
		busy = max(0.0, now[0] - busy - others[0])
		clock = max(0.0, now[1] - clock - others[1])
		steps = O.iter - first
		if steps <= 0:
			return
		count, kind = self._particles(first)
		self.steps += steps
		self.particle_steps += steps * count
		self.cpu_s += busy
		self.wall_s += clock
		for name, seconds in took.items():
			if name not in self.apart:
				self.engines[name] = self.engines.get(name, 0.0) + seconds
		total = self._kinds.setdefault(kind, [0, 0, 0.0, count, count])
		total[:3] = total[0] + steps, total[1] + steps * count, total[2] + busy
		total[3:] = min(total[3], count), max(total[4], count)

	def _of_others(self, took):
		"""Time of the engines apart, of what each engine took [s]."""
		return sum(took.get(name, 0.0) for name in self.apart)

	def _particles(self, first):
		"""Their number and kind; counted once for a scene whose bodies stay, since who steps one by one asks
		often."""
		scene = O.iter, len(O.bodies)
		if self._scene != (first, scene[1]):
			self._count = particles(), kind()
			if self._count[0] >= self.particles:
				self.particles, self.unknowns, self.dt = self._count[0], unknowns(), O.dt
				self.bytes_per_particle = bytes_per_particle()
		self._scene = scene
		return self._count

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


def _times():
	"""Time of each engine so far, by its label or class, where O.timingEnabled says it [s]."""
	if not O.timingEnabled:
		return {}
	times = {}
	for engine in O.engines:
		name = engine.label or type(engine).__name__
		times[name] = times.get(name, 0.0) + 1e-9 * engine.execTime
	return times
