# GPL v2 or later, see LICENSE.
"""The arrays that samples hand out: ids that YADE takes, and values that nobody can write to in vain."""
import numpy as np

#: what these make of ids are ids
_SETS = (np.setdiff1d, np.intersect1d, np.union1d, np.unique, np.concatenate)


class BodyIds(np.ndarray):
	"""Body ids as an array of whole numbers; what is taken out of it one by one is Python's own int.

	YADE refuses numpy's integers, so an array of them is of no use for ``O.bodies[i]``,
	``TranslationEngine(ids=…)`` or ``O.forces.addF(i, …)``. This one is taken by all of them, and stays what it
	is when indexed, sliced, joined (:func:`numpy.concatenate`) or compared as sets (:func:`numpy.setdiff1d` and
	its like). It cannot be changed in place. What arithmetic makes of it is a plain array. The few functions that
	want a list (``utils.sumForces``) take ``list(ids)``.
	"""

	def __new__(cls, ids):
		given = np.asarray(ids)
		if given.size and given.dtype.kind not in "iu":
			raise ValueError(f"ids of bodies must be whole numbers, not {given.flat[0]!r} ({given.dtype})")
		made = np.array(given, dtype=int).view(cls)
		made.setflags(write=False)
		return made

	def __getitem__(self, index):
		found = super().__getitem__(index)
		return int(found) if isinstance(found, np.integer) else found

	def __iter__(self):
		return iter(self.tolist()) if self.ndim == 1 else super().__iter__()

	def __array_wrap__(self, array, context=None, return_scalar=False):
		if array.ndim == 0:
			return array.item()  # such as ids.max()
		return np.asarray(array)

	def __array_function__(self, function, types, arguments, options):
		found = super().__array_function__(function, types, arguments, options)
		return found.view(BodyIds) if function in _SETS and type(found) is np.ndarray else found


def fixed(array):
	"""The array, not to be written to: what was written would reach neither bodies nor engine, and be lost without
	a word.
	"""
	seen = array.view()
	seen.setflags(write=False)
	return seen
