# shellcheck shell=bash
# GPL v2 or later, see LICENSE.
# Runs the groups of tests and adds up their results.

# run_tests [--all] [PYTEST ARGUMENTS]: the kernel's GoogleTests, pytest inside YADE, and pytest alone for the tests of
# launcher and build.  With arguments, only pytest; with files or folders among them, only those.
# Succeeds when no test has failed.
run_tests() {
	local results=$build_dir/test-results all='' argument folder options=() in_yade=() alone=() reports=()
	[[ ${1:-} == --all ]] && all=--all && shift
	for argument in "$@"; do
		if [[ ! -e ${argument%%::*} ]]; then
			options+=("$argument")
		elif [[ $(realpath "${argument%%::*}")/ =~ /tests/(launcher|build)/ ]]; then
			alone+=("$argument")
		else
			in_yade+=("$argument")
		fi
	done
	if ((${#in_yade[@]} + ${#alone[@]} == 0)); then
		for folder in "$checkout"/tests/*/; do
			case $folder in
				*/kernel/ | */data/ | */__pycache__/) ;;
				*/launcher/ | */build/) alone+=("${folder%/}") ;;
				*) in_yade+=("${folder%/}") ;;
			esac
		done
	fi
	as_caller rm -rf "$results"
	as_caller mkdir -p "$results"
	# Nothing is left behind in the checkout.
	export DDEM_BUILD_DIR=$build_dir/build PYTHONDONTWRITEBYTECODE=1
	export HYPOTHESIS_STORAGE_DIRECTORY=$build_dir/hypothesis
	# No test has a time of its own in which it must be done; what goes on for an hour hangs on any machine.
	local pytest=(-p no:cacheprovider --timeout=3600 --timeout-method=thread ${all:+--all} "${options[@]}")

	if (($# == 0)); then
		say "kernel (GoogleTest)"
		inside "$build_dir/build/kernel_tests" --gtest_brief=1 "--gtest_output=xml:$results/kernel.xml" \
			"${all:---gtest_filter=-*Slow*}" || true
		reports+=("kernel=$results/kernel.xml")
	fi
	if ((${#in_yade[@]})); then
		say "inside YADE (pytest)"
		inside yade -n -x "$checkout/tests/yade/run_pytest.py" "${pytest[@]}" "--junitxml=$results/yade.xml" \
			"${in_yade[@]}" || true
		reports+=("yade=$results/yade.xml")
	fi
	if ((${#alone[@]})); then
		say "launcher and build (pytest)"
		inside python3 -m pytest "${pytest[@]}" "--junitxml=$results/alone.xml" "${alone[@]}" || true
		reports+=("launcher=$results/alone.xml")
	fi
	inside python3 "$setup_dir/count_results.py" "${reports[@]}"
}
