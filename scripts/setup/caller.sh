# shellcheck shell=bash
# GPL v2 or later, see LICENSE.
# Whose files these are: the caller, also when the launcher was started with sudo; the caller's cache; the lock that keeps two launchers apart.

# find_caller: sets caller_uid, caller_gid, caller_home.
find_caller() {
	caller_uid=$(id -u) caller_gid=$(id -g) caller_home=${HOME:-}
	if ((caller_uid == 0)) && [[ ${SUDO_UID:-0} != 0 ]]; then
		caller_uid=$SUDO_UID caller_gid=${SUDO_GID:-$SUDO_UID}
		caller_home=
	fi
	[[ $caller_home ]] || caller_home=$(getent passwd "$caller_uid" | cut -d: -f6)
	[[ -d $caller_home ]] || caller_home=/tmp
	readonly caller_uid caller_gid caller_home
}

# find_cache: sets cache_dir (everything the launcher makes is in it), build_dir (one per checkout and Debian release), log_dir.
find_cache() {
	local name
	cache_dir=${XDG_CACHE_HOME:-$caller_home/.cache}/yade-ddem
	name=$(basename "$checkout")-$(printf '%s' "$checkout" | sha256sum | cut -c1-8)
	build_dir=$cache_dir/builds/$name-$1
	log_dir=$cache_dir/logs
	as_caller mkdir -p "$build_dir" "$log_dir" 2>/dev/null || fail "cannot write to $cache_dir (XDG_CACHE_HOME chooses another place)"
	readonly cache_dir build_dir log_dir
}

# as_caller COMMAND…: as the user who called, not as root through sudo.
as_caller() {
	if ((caller_uid == EUID)); then
		"$@"
	else
		"$setup_dir/as_user.sh" "$caller_uid" "$caller_gid" "$caller_home" "$@"
	fi
}

# The lock is a file descriptor that children inherit: when the launcher is killed outright, an apt or debootstrap that it leaves behind still
# holds the lock until it is done, and the next start waits for it instead of working in the same directory.
take_lock() {
	exec 9>>"$cache_dir/lock"
	if ! flock --nonblock 9; then
		say "another scripts/ddem is setting up (it holds $cache_dir/lock); waiting for it"
		flock 9
	fi
}

release_lock() { exec 9>&-; }
