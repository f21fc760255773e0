# shellcheck shell=bash
# GPL v2 or later, see LICENSE.
# Whose files these are: the caller, also when the launcher was started with sudo; the caller's cache; the locks that
# keep launchers apart.

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

# find_cache RELEASE: sets cache_dir (everything the launcher makes is in it), build_dir (one per checkout and release)
# and log_dir inside.
find_cache() {
	local name
	cache_dir=${XDG_CACHE_HOME:-$caller_home/.cache}/yade-ddem
	name=$(basename "$checkout")-$(printf '%s' "$checkout" | sha256sum | cut -c1-8)
	build_dir=$cache_dir/builds/$name-$1
	log_dir=$build_dir/logs
	as_caller mkdir -p "$log_dir" 2>/dev/null \
		|| fail "cannot write to $cache_dir (XDG_CACHE_HOME chooses another place)"
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

# There are two locks, always taken in this order.  The checkout's (descriptor 9) is held by whoever builds it, or looks
# whether it is built.  The environment's (descriptor 8) is shared by all who look at it or build in it, so that no
# checkout waits for another's build, and held alone while it changes.  Programs that run hold neither: a package puts
# its files in place by renaming, as on every Debian machine.
#
# A lock is a file descriptor that children inherit: when the launcher is killed outright, an apt, debootstrap or
# compiler that it leaves behind still holds the lock until it is done, and the next start waits for it instead of
# working in the same place.

# lock_checkout: nobody else builds this checkout from here on.
lock_checkout() {
	lock_file "$build_dir.lock"
	exec 9>>"$build_dir.lock"
	take_lock 9 --exclusive "another scripts/ddem is setting up this checkout (it holds $build_dir.lock)"
}

# share_environment: nobody changes the environment from here on.
share_environment() {
	open_environment_lock
	take_lock 8 --shared "another scripts/ddem is changing the environment (it holds $environment_lock)"
}

# own_environment: nobody else changes it or builds in it from here on.  What was shared is let go first, since two that
# waited for each other's share would wait for ever; so look again whether there is still anything to do.
own_environment() {
	open_environment_lock
	take_lock 8 --exclusive \
		"another scripts/ddem is at work in the environment, which is to change (it holds $environment_lock)"
}

# open_environment_lock: opened anew it is not held, whatever was.
open_environment_lock() {
	environment_lock=$cache_dir/environment.lock
	lock_file "$environment_lock"
	exec 8>>"$environment_lock"
}

release_locks() { exec 8>&- 9>&-; }

# lock_file FILE: is there, and the caller's, also when the launcher was started with sudo.
lock_file() { [[ -e $1 ]] || as_caller touch "$1"; }

# take_lock DESCRIPTOR MODE WHO
take_lock() {
	flock --nonblock "$2" "$1" && return
	say "$3; waiting for it"
	flock "$2" "$1"
}
