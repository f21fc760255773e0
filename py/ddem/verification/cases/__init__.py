# GPL v2 or later, see LICENSE.
"""The verification cases, one concept or family a file; how to write one: see :mod:`yade.ddem.verification`."""
