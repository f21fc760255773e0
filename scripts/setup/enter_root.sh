#!/bin/bash
# GPL v2 or later, see LICENSE.
# Runs a command inside a Debian root, in a mount namespace of its own: nothing stays mounted, and the command replaces
# this process, so signals and exit codes pass through.  Usage:
#   enter_root.sh ROOT --system -- COMMAND…                         /proc, /sys, /dev only (to install packages)
#   enter_root.sh ROOT --caller UID GID HOME DIRECTORY… -- COMMAND…  with the caller's files at the same paths,
#                                                                    as the caller, in the same directory
set -euo pipefail

# First half: outside the namespace.
if [[ ${1:-} != --inside ]]; then
	exec unshare --mount --propagation private "$0" --inside "$@"
fi
shift

# bind_directory DIRECTORY: makes it visible at the same path inside.
bind_directory() {
	mkdir -p "$root$1" 2>/dev/null && mount --rbind "$1" "$root$1"
}

# Every directory of / that is not the operating system's own (/home, /tmp, /srv, /mnt, /data …),
# whatever it is called here.
bind_callers_directories() {
	local entry directory
	for entry in /*; do
		case $entry in
			/bin | /boot | /dev | /etc | /lib* | /lost+found | /proc | /run | /sbin | /sys | /usr | /var) ;;
			*) if [[ -L $entry ]]; then
				[[ -e $root$entry ]] || cp -P "$entry" "$root$entry"
			elif [[ -d $entry ]]; then
				bind_directory "$entry"
			fi ;;
		esac
	done
	[[ ! -d /run/user ]] || bind_directory /run/user
	# Directories that matter even though they lie below a system one, as in /var/lib/jenkins/workspace.
	for directory in "$@"; do
		[[ -d $directory ]] || continue
		[[ $(stat -c %d:%i "$root$directory" 2>/dev/null) == "$(stat -c %d:%i "$directory")" ]] && continue
		[[ ! -d $root$directory || -z $(ls -A "$root$directory") ]] && bind_directory "$directory"
	done
}

bind_file() {
	local file
	file=$(readlink -f "$1") && [[ -f $file ]] || return 0
	[[ ! -L $root$1 ]] || rm -f "$root$1"
	[[ -e $root$1 ]] || : >"$root$1"
	mount --bind "$file" "$root$1"
}

root=$1 here=$PWD
shift
for system in proc sys dev; do mount --rbind /$system "$root/$system"; done
bind_file /etc/resolv.conf
bind_file /etc/hosts

as_whom=(env -C /)
if [[ $1 == --caller ]]; then
	uid=$2 gid=$3 home=$4 directories=()
	shift 4
	while [[ $1 != -- ]]; do directories+=("$1") && shift; done
	bind_callers_directories "$home" "$here" "${directories[@]}"
	bind_file /etc/passwd
	bind_file /etc/group
	bind_file /etc/localtime
	# This machine's own libraries and languages mean nothing inside.
	as_whom=(env -C "$here" -u LD_LIBRARY_PATH -u LD_PRELOAD -u PYTHONHOME -u LC_ALL LANG=C.UTF-8 "HOME=$home")
	# the checkout is visible inside
	((uid == 0)) || as_whom=("$(dirname "$(readlink -f "$0")")/as_user.sh" "$uid" "$gid" "$home" "${as_whom[@]}")
else
	shift
fi
shift
exec chroot "$root" "${as_whom[@]}" PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin "$@"
