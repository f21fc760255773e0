# GPL v2 or later, see LICENSE.
# Times the steps of a saved scene: yade -n -x estimate_run.py REQUEST ANSWER. Started by estimate.estimate.
import sys

from yade.ddem.accuracy import estimate

estimate.answer(*sys.argv[1:3])
