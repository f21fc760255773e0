# GPL v2 or later, see LICENSE.
"""Structures of the report and beyond, each a scene that scripts, verification cases and benchmarks share.

A function builds the scene, runs it and returns what happened as plain arrays; the scene stays as it is at the end.
Begin with O.reset().

=====================  =================================================================================================
:mod:`impulse`         elastic block under a horizontal impulse: Zubelewicz (2018), section 4.2
:mod:`reinforced`      concrete block with a steel bar, crushed at 10 m/s: Zubelewicz (2018), section 4.3
:mod:`beam`            notched beam in three-point bending
:mod:`confined`        block crushed under lateral pressure
:mod:`spall`           bar in which a pulse comes back from the free end as tension
=====================  =================================================================================================
"""
