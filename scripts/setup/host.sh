# shellcheck shell=bash disable=SC2016 # $(…) in single quotes is for apt and dpkg
# GPL v2 or later, see LICENSE.
# What this machine offers: a YADE that is new enough, and the address of the Debian archive it uses.

readonly YADE_MINIMUM=2025.2

# os_release KEY: what /etc/os-release says.
os_release() { sed -n "s/^$1=\"\{0,1\}\([^\"]*\)\"\{0,1\}$/\1/p" /etc/os-release 2>/dev/null; }

# Version of the yade program on this machine; nothing when there is none.
host_yade_version() { { yade --version 2>/dev/null || true; } | sed -n "s/^Yade version: *\([0-9.]*\).*/\1/p"; }

version_at_least() { [[ $1 ]] && [[ $(printf '%s\n' "$2" "$1" | sort -V | head -n 1) == "$2" ]]; }

# Packages a file of ours lists, without its comments.
listed_packages() { sed -e 's/#.*//' "$setup_dir/packages" | tr -s ' \t\n' ' '; }

# find_needed WHO FILE…: sets needed, the packages that scripts ask for with "# needs: NAME …" in the comments at their
# top; WHO is named in complaints.
find_needed() {
	local who=$1 package
	shift
	needed=()
	while read -r package; do
		[[ $package =~ ^[a-z0-9][a-z0-9+.-]+$ ]] \
			|| usage_error "$who: a script needs '$package', which is not the name of a Debian package"
		needed+=("$package")
	done < <(awk '
		FNR == 1 { top = 1 }
		!/^#/ { top = 0 }
		top && sub(/^# needs:/, "") { for (i = 1; i <= NF; i++) print $i }
	' "$@" | sort -u)
}

# missing_packages NAME…: those of them this machine lacks.
missing_packages() {
	local package
	for package in "$@"; do
		[[ $(dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null) == installed ]] \
			|| printf '%s ' "$package"
	done
}

# archive_address [FIELD…]: what apt's own configuration says about the Debian archive this machine uses;
# the URI when no field is named.
archive_address() {
	local codename
	[[ $(os_release ID) == debian ]] || return 0
	codename=$(os_release VERSION_CODENAME)
	apt-get indextargets --format '$(REPO_URI) $(RELEASE)' 'Created-By: Packages' 'Component: main' 2>/dev/null \
		| awk -v r="$codename" '$2 == r && $1 ~ /^https?:/ { print $1; exit }'
}

# apt_get ARGUMENTS…: on this machine, as root, waiting for any other apt;
# refreshes the lists of packages when there are none.
apt_get() {
	[[ $(apt-get indextargets --format '$(FILENAME)' 'Created-By: Packages' \
		| head -n 1 | xargs -r ls 2>/dev/null) ]] || apt-get -qq update
	DEBIAN_FRONTEND=noninteractive apt-get -o DPkg::Lock::Timeout=600 -o APT::Status-Fd=1 "$@"
}
