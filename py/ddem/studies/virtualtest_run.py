# GPL v2 or later, see LICENSE.
# One evaluation of a calibration, in a YADE of its own: yade -n -x virtualtest_run.py REQUEST ANSWER.
# Started by virtualtest.SeparateYade.
import sys

from yade.ddem.studies import virtualtest

virtualtest.answer(*sys.argv[1:3])
