# shellcheck shell=bash
# GPL v2 or later, see LICENSE.
# What the launcher tells people: phases with progress and duration, and errors of one clear line.  Everything goes to
# stderr; stdout belongs to the scripts.

readonly EXIT_USAGE=2 EXIT_ENVIRONMENT=125 EXIT_INTERRUPTED=130

say() { printf 'ddem: %s\n' "$*" >&2; }

# fail MESSAGE…: the environment cannot be prepared.
fail() {
	say "error: $*"
	exit $EXIT_ENVIRONMENT
}

usage_error() {
	say "error: $* (see 'scripts/ddem --help')"
	exit $EXIT_USAGE
}

# phase [--if-work] NAME COMMAND…: runs a function or command with its output in $log_dir/NAME.log; shows progress, says
# how long it took.  On failure: one line, and exit.
# With --if-work it stays silent when the command finds nothing to do.
phase() {
	local name log started=$SECONDS status=0 silent=
	if [[ $1 == --if-work ]]; then silent=$2 && shift; fi
	name=$1 log=$log_dir/${1//[^A-Za-z0-9]/-}.log
	shift
	[[ $silent ]] || say "$name …"
	# In a subshell with a file of its own: what the command leaves behind must be on disk,
	# where an interrupted run finds it again.
	("$@") 2>&1 </dev/null | show_progress "$log" "$silent" || status=$?
	if ((status != 0)); then
		((status < 128)) || { say "$name: stopped; the same command goes on from here"; exit "$status"; }
		fail "$name failed: $(reason "$log") (all output: $log)"
	fi
	[[ $silent && $(cat "$log.work" 2>/dev/null) != yes ]] || say "$name: $(duration $((SECONDS - started)))"
}

duration() {
	if (($1 < 60)); then echo "$1 s"; else echo "$(($1 / 60)) min $(($1 % 60)) s"; fi
}

# show_progress LOG [NAME]: copies stdin to LOG; on the way recognises how far debootstrap, apt and ninja say they are,
# and shows it: on a terminal as one line that changes, elsewhere as a line every quarter.  With NAME, that is said
# before the first progress; LOG.work then holds whether there was any.
show_progress() {
	local line steps=0 text percent last='' last_text='' quarter=-1 unsaid=${2:-}
	rm -f "$1.work"
	while IFS= read -r line; do
		printf '%s\n' "$line" >&3
		percent=
		if [[ $line =~ ^dlstatus:[^:]*:([0-9]+) ]]; then
			text=downloading percent=${BASH_REMATCH[1]}
		elif [[ $line =~ ^pmstatus:[^:]*:([0-9]+) ]]; then
			text=installing percent=${BASH_REMATCH[1]}
		elif [[ $line =~ ^I:\ (Retrieving|Validating|Extracting|Unpacking|Configuring) ]]; then
			steps=$((steps + 1)) # debootstrap does these five for each of some 80 packages
			text=unpacking percent=$((steps < 400 ? steps / 4 : 99))
		elif [[ $line =~ ^\[([0-9]+)/([0-9]+)\] && $line != *globbed* ]]; then
			text=compiling percent=$((BASH_REMATCH[1] * 100 / BASH_REMATCH[2]))
		fi
		[[ $percent ]] || continue
		if [[ $unsaid ]]; then
			say "$unsaid …"
			unsaid=
			echo yes >"$1.work"
		fi
		if [[ -t 2 ]]; then
			[[ $text$percent == "$last" ]] || printf '\r\033[Kddem:   %s %d %%' "$text" "$percent" >&2
			last=$text$percent
		elif [[ $text != "$last_text" ]] || ((percent / 25 > quarter)); then
			say "  $text $percent %"
			last_text=$text quarter=$((percent / 25))
		fi
	done 3>"$1"
	[[ -z $last ]] || printf '\r\033[K' >&2
}

# reason LOG: the cause of a failed phase in a few words.
reason() {
	local network='could not resolve|temporary failure resolving|name resolution|unable to connect'
	network+='|cannot initiate the connection|network is unreachable|connection (timed out|refused)'
	network+='|failed to fetch|couldn.t download|failed getting release file'
	if grep -qiE 'no space left on device|not enough free space|You don.t have enough free space' "$1"; then
		echo "no space left in $cache_dir"
	elif grep -qiE "$network" "$1"; then
		echo "no network: cannot reach the Debian archive"
	elif grep -qE '(^|: )(fatal )?[eE]rror:|^CMake Error|^E: ' "$1"; then
		# CMake wraps its messages over several lines: take the first ones after the heading as well.
		grep -m1 -A6 -E '(^|: )(fatal )?[eE]rror:|^CMake Error|^E: ' "$1" | tr -s ' \n' '  ' | cut -c1-600
	else
		grep -v '^$' "$1" | tail -n 1
	fi
}
