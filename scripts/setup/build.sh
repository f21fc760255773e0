# shellcheck shell=bash
# GPL v2 or later, see LICENSE.
# Builds the plugin and installs it into an overlay prefix: CMake and ninja find out what has changed.

# build_plugin [--strict] [TARGET…]: afterwards $overlay is a YADE prefix with the plugin, and the targets
# (kernel_tests, kernel_bench) are built as well.
build_plugin() {
	local identity strict='' stamp=$build_dir/configured
	if [[ ${1:-} == --strict ]]; then strict=--strict && shift; fi
	overlay=$build_dir/overlay
	identity="$yade_source $(stat -Lc '%s %Y' "$root$(command -v yade || echo /usr/bin/yade)") $strict"
	case $(cat "$stamp" 2>/dev/null) in
		# an earlier --strict build stays strict: going back would compile everything again
		"$identity" | "$identity--strict") ;;
		*) phase "configuring the plugin" configure "$stamp" "$identity" "$strict" ;;
	esac
	phase --if-work "building the plugin" compile "$@"
	phase --if-work "installing the plugin" inside cmake --install "$build_dir/build"
}

configure() {
	local stamp=$1 identity=$2 strict=$3
	as_caller rm -f "$stamp"
	inside cmake -S "$checkout" -B "$build_dir/build" -G Ninja -DCMAKE_BUILD_TYPE=Release \
		-DYADE_SOURCE_DIR="$yade_source" -DDDEM_OVERLAY="$overlay" \
		${strict:+-DDDEM_WARNINGS_AS_ERRORS=ON} || return
	printf '%s' "$identity" | as_caller tee "$stamp" >/dev/null
}

compile() { inside cmake --build "$build_dir/build" --parallel "$(jobs_that_fit)" --target plugin "$@"; }

# YADE's headers make the compiler take up to 2 GB a file.
jobs_that_fit() {
	local by_memory
	by_memory=$(awk '/^MemAvailable/ { print int($2 / 2000000) }' /proc/meminfo)
	printf '%s\n' "$((by_memory > 0 ? by_memory : 1))" "$(nproc)" | sort -n | head -n 1
}
