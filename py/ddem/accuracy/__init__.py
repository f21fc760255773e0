# GPL v2 or later, see LICENSE.
"""What accuracy costs in time: ladders of settings, run, compared and told.

===================  ============================================================================================
:mod:`ladders`       the data: scenes, settings, quantities
:mod:`study`         runs ladders in one folder, within a budget, to a target; :mod:`rungs`: one setting of them
:mod:`points`        errors, costs and the front; :mod:`convergence`: their arithmetic
:mod:`sentences`     what the points say; :mod:`recommendation`: the cheapest settings for an error
:mod:`figures`       what they look like, and :mod:`page`; :mod:`section`: the same for the report of a run
:mod:`prediction`    rungs that nobody has run; :mod:`estimate`: what a run will take, before it is run;
                     :mod:`scene_cost`: what its steps cost, in a copy of it
===================  ============================================================================================
"""
from .._lazy import lazy

_MODULES = (
	"convergence", "estimate", "figures", "ladders", "page", "points", "prediction", "recommendation", "rungs",
	"scene_cost", "section", "sentences", "study"
)
__getattr__, __dir__ = lazy(globals(), dict.fromkeys(_MODULES))
