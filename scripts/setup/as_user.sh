#!/bin/sh
# GPL v2 or later, see LICENSE.
# as_user.sh UID GID HOME COMMAND…: becomes the command, run by root in the name of a user
# (who need not be in this system's list of users).
uid=$1 gid=$2 home=$3
shift 3
if getent passwd "$uid" >/dev/null; then groups=--init-groups; else groups=--clear-groups; fi
exec setpriv "--reuid=$uid" "--regid=$gid" $groups env "HOME=$home" "$@"
