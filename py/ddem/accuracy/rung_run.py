# GPL v2 or later, see LICENSE.
# One rung of a ladder, in a YADE of its own: yade -n -x rung_run.py REQUEST ANSWER. Started by rungs.SeparateRung.
import sys

from yade.ddem.accuracy import rungs

rungs.answer(*sys.argv[1:3])
