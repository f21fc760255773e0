# GPL v2 or later, see LICENSE.
# Runs pytest inside YADE: yade -n -x tests/yade/run_pytest.py [pytest arguments; the default is this folder]
import os
import sys

import pytest

sys.exit(pytest.main(sys.argv[1:] or [os.path.dirname(os.path.abspath(sys.argv[0]))]))
