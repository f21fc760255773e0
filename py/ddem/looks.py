# GPL v2 or later, see LICENSE.
"""Which of YADE's functions touch State of bodies, and which touch none.

While a PyRunner acts, State of deformable bodies lags behind the engine's arrays, and the engine watches which
functions the Python code calls. Those of :func:`touching_one_state` bring one body up to date, those of
:func:`touching_nothing` none; *all others bring every body up to date first*. So this list decides about time only, as
long as every function in it touches nothing; leave out what you are not sure of.
"""
import re

from yade import minieigenHP, wrapper

#: of Omega: what is called, and what is read
_OMEGA = "labeledEngine"
_OMEGA_READ = """
	iter subStep subStepping stopAtIter stopAtTime time realtime speed dt dynDt dynDtAvailable running filename
	numThreads timingEnabled forceSyncCount tags energy forces
	engines bodies interactions materials cell periodic trackEnergy
"""
_BODY_READ = "dynamic bounded aspherical mask mat isStandalone isClump isClumpMember"
_METHODS = {
	"BodyContainer": "__getitem__ __len__ __iter__",
	"BodyIterator": "__iter__ __next__ next",
	"InteractionContainer": "__getitem__ __len__ __iter__ has countReal nth withBody withBodyAll all",
	"InteractionIterator": "__iter__ __next__ next",
	"MaterialContainer": "__getitem__ __len__ index",
	"ForceContainer": "f t m addF addT permF permT setPermF setPermT reset getPermForceUsed",
	"EnergyTracker": "__getitem__ keys items total",
	"TagsWrapper": "__getitem__ __setitem__ keys has_key",
	# our own read the arrays, not State
	"DeformableEngine": "criticalTimeStep rulingTriangle array values fields groups",
	"DeformableTriangle": "stress strain plasticStrain damageTensor damage rotation area",
	"BondedInteractionLoop": "sphereArray existing",
	"BondedNewtonIntegrator": "moved",
	"Law2_ScGeom_BondedPhys_Bonded":
		"brokenBonds brokenCount brokenAmong brokenArrays bonds bondArrays bytesPerBond",
}
_TRIGGERS_POST_LOAD = 4  # Attr::triggerPostLoad: code that may look at anything runs when such an attribute is set


def _parts(member):
	"""The functions behind a class's member: of a property reading and writing."""
	if isinstance(member, property):
		return [member.fget, member.fset]
	return [member.__func__ if isinstance(member, staticmethod) else member, None]


def _functions(found):
	"""Those of Boost.Python among them, which alone are watched."""
	kind = type(vars(wrapper.State)["displ"])
	return [function for function in found if isinstance(function, kind)]


def touching_one_state():
	"""Functions whose first argument is the State they read or write: all of State and what derives from it."""
	classes = [
		owner
		for owner in vars(wrapper).values()
		if isinstance(owner, type) and issubclass(owner, wrapper.State)
	]
	members = [vars(owner)[name] for owner in classes for name in vars(owner) if not name.startswith("__")]
	return _functions(part for member in members for part in _parts(member))


def touching_nothing():
	"""Functions that neither read nor write State of any body, nor anything that the engine's arrays depend on,
	nor what decides which engines act, and may look, in the next step."""
	found = []
	for owner in vars(wrapper).values():
		# geometry and physics of bonds lag as State does
		if not isinstance(owner, type) or issubclass(owner, (wrapper.State, wrapper.IGeom, wrapper.IPhys)):
			continue
		# Setting an attribute of a body, shape or material means something to the arrays;
		# of other engines it does not.
		# Those of Engine and PeriodicEngine themselves say when an engine acts, and so, who looks.
		timing = owner in (wrapper.Engine, wrapper.PeriodicEngine, wrapper.DeformableEngine)
		settable = issubclass(owner, wrapper.Engine) and not timing
		for member in vars(owner).values():
			doc = getattr(member, "__doc__", None) or ""
			if not isinstance(member, property) or ":yattrtype:" not in doc:
				continue  # not a plain attribute, but code
			found.append(member.fget)
			flags = re.search(r":yattrflags:`(\d+)`", doc)
			if settable and flags and not int(flags[1]) & _TRIGGERS_POST_LOAD:
				found.append(member.fset)
	listed = {**_METHODS, "Omega": _OMEGA}
	for owner, names in listed.items():
		for name in names.split():
			found += _parts(vars(getattr(wrapper, owner)).get(name))
	for owner, names in ((wrapper.Omega, _OMEGA_READ), (wrapper.Body, _BODY_READ)):
		found += [_parts(vars(owner).get(name))[0] for name in names.split()]
	for owner in vars(minieigenHP).values():  # vectors and matrices
		if isinstance(owner, type):
			# which all classes share
			members = [member for name, member in vars(owner).items() if name != "__reduce__"]
			found += [part for member in members for part in _parts(member)]
	return _functions(found)
