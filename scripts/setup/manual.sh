# shellcheck shell=bash
# GPL v2 or later, see LICENSE.
# Makes the manual with Sphinx, inside YADE, whose classes and doc strings it shows.

# make_manual FOLDER: HTML pages; nothing is left behind in the checkout.
make_manual() {
	export YADE_PREFIX=$overlay PYTHONDONTWRITEBYTECODE=1
	inside yade -n -x "$checkout/scripts/manual/build.py" "$1" || fail "the manual has errors, see above"
}
