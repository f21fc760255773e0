# shellcheck shell=bash disable=SC2016 # $(…) in single quotes is for apt and dpkg
# GPL v2 or later, see LICENSE.
# A Debian 13 userland in the cache directory, for machines whose own YADE is missing or too old.  Each step leaves
# a stamp when it is complete and begins by clearing what an interrupted one has left,
# so a start after kill -9 goes on where it must.

readonly DEBIAN_RELEASE=trixie
readonly ROOT_NEEDS_MB=4500

root_stamp() { echo "$root/var/lib/yade-ddem/$1"; }

require_root_rights() {
	((EUID == 0)) || fail "this machine has no YADE >= $YADE_MINIMUM of its own," \
		"and making and entering a Debian 13 environment takes root: sudo $0 …"
	unshare --mount --propagation private true 2>/dev/null \
		|| fail "no right to make a mount namespace, which the Debian 13 environment needs" \
			"(in a container: start it with --privileged or --cap-add SYS_ADMIN)"
}

require_space() {
	local free
	free=$(df -Pm "$cache_dir" | awk 'NR == 2 { print $4 }')
	((free >= ROOT_NEEDS_MB)) \
		|| fail "$cache_dir has $free MB free, the Debian 13 environment needs $ROOT_NEEDS_MB MB" \
			"(XDG_CACHE_HOME chooses another place)"
}

# packages_stamp: there once all listed packages are.
packages_stamp() { root_stamp "packages-$(listed_packages | sha256sum | cut -c1-16)"; }

root_is_ready() { [[ -f $(packages_stamp) && -z $(missing_in_root "${needed[@]}") ]]; }

make_debian_root() {
	[[ ! -f $(packages_stamp) ]] || return 0
	require_space
	say "making a Debian 13 environment with YADE in $root (once; about 3 GB, 3 minutes)"
	if [[ ! -d $root ]]; then
		[[ -x $(command -v debootstrap) && -f /usr/share/keyrings/debian-archive-keyring.gpg ]] \
			|| phase "installing debootstrap" install_debootstrap
		phase "Debian 13 base system" make_base_system
	fi
	phase "Debian 13 packages" install_packages "$(packages_stamp)"
}

install_debootstrap() {
	if [[ ! -x $(command -v apt-get) ]]; then
		echo "error: this machine has no apt-get: install debootstrap and debian-archive-keyring by hand"
		return 1
	fi
	apt_get install -y --no-install-recommends debootstrap debian-archive-keyring
}

# Debootstrap cannot go on from where it was stopped: it works beside the final place,
# and a complete result is moved there in one step.
make_base_system() {
	local unfinished=$root.unfinished address
	local debootstrap=(debootstrap --variant=minbase --keyring=/usr/share/keyrings/debian-archive-keyring.gpg)
	address=$(archive_address)
	proxy_for_debootstrap
	rm -rf --one-file-system "$unfinished"
	# In a namespace of its own: what debootstrap mounts vanishes with it even if it is killed.
	if ! unshare --mount --propagation private \
		"${debootstrap[@]}" $DEBIAN_RELEASE "$unfinished" ${address:+"$address"}; then
		[[ $address ]] || return
		echo "The archive of this machine's apt does not serve $DEBIAN_RELEASE; trying debootstrap's default."
		rm -rf --one-file-system "$unfinished"
		unshare --mount --propagation private "${debootstrap[@]}" $DEBIAN_RELEASE "$unfinished" || return
	fi
	mkdir -p "$unfinished/var/lib/yade-ddem"
	sync -f "$unfinished"
	mv "$unfinished" "$root"
}

proxy_for_debootstrap() {
	local proxy=
	eval "$(apt-config shell proxy Acquire::http::Proxy 2>/dev/null)"
	[[ -z $proxy || ${http_proxy:-} ]] || export http_proxy=$proxy
	proxy=
	eval "$(apt-config shell proxy Acquire::https::Proxy 2>/dev/null)"
	[[ -z $proxy || ${https_proxy:-} ]] || export https_proxy=$proxy
}

install_packages() {
	local stamp=$1
	# shellcheck disable=SC2046 # one word a package
	apt_install_in_root $(listed_packages) || return
	fetch_headers_in_root || return
	clear_root_apt
	touch "$stamp"
}

# install_needed: the packages in $needed, which are not worth having for those who never run the
# scripts that ask for them.
install_needed() {
	local missing
	missing=$(missing_in_root "${needed[@]}")
	# shellcheck disable=SC2086 # one word a package
	[[ -z $missing ]] || phase "Debian packages ${missing% }" install_more $missing
}

# missing_in_root NAME…: those of them the root lacks.
missing_in_root() {
	local package
	for package in "$@"; do
		[[ $(in_root dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null) == installed ]] \
			|| printf '%s ' "$package"
	done
}

install_more() {
	apt_install_in_root "$@" || return
	clear_root_apt
}

apt_install_in_root() {
	wait_for_orphans
	configure_root_apt
	# an interrupted start; what is still broken, apt completes below
	in_root dpkg --configure --pending --force-confdef || true
	in_root apt-get update || return
	in_root apt-get -o APT::Status-Fd=1 -o DPkg::Lock::Timeout=600 \
		install -y --fix-broken --no-install-recommends "$@"
}

clear_root_apt() {
	in_root apt-get clean
	rm -rf "$root"/var/lib/apt/lists/*
	sync -f "$root"
}

# A dpkg does not inherit our lock from its apt: when only the latter was killed, it is still at work.
wait_for_orphans() {
	local orphan said=
	while orphan=$(process_in_root '^(dpkg|apt-get)$') && [[ $orphan ]]; do
		[[ $said ]] || echo "waiting for process $orphan, which an earlier start has left behind"
		said=yes
		sleep 1
	done
}

# process_in_root PATTERN: number and name of one that is at work in the root and whose name fits.
process_in_root() {
	local process name
	for process in /proc/[0-9]*; do
		name=$(cat "$process/comm" 2>/dev/null) || continue
		[[ $name =~ $1 && $(readlink "$process/root") == "$root" ]] || continue
		echo "${process#/proc/} ($name)"
		return
	done
}

forget_root() {
	local busy
	own_environment
	busy=$(process_in_root .)
	[[ -z $busy ]] || fail "process $busy is at work in $root: end it first"
	rm -rf --one-file-system "$root" "$root.unfinished"
}

# The root's apt: the archive debootstrap has used, with sources for the headers;
# this machine's proxies and certificates; no documentation.
configure_root_apt() {
	local archive certificates
	archive=$(awk '$1 == "deb" { print $2; exit }' "$root/etc/apt/sources.list")
	printf '%s %s %s main\n' deb "$archive" $DEBIAN_RELEASE deb-src "$archive" $DEBIAN_RELEASE \
		>"$root/etc/apt/sources.list"
	certificates=/etc/ssl/certs/ca-certificates.crt
	eval "$(apt-config shell certificates Acquire::https::CaInfo 2>/dev/null)"
	{
		apt-config dump 2>/dev/null | grep -E '^Acquire::([a-z]+::Proxy|https?::|Retries|ForceIPv)' \
			| grep -vE 'Proxy-Auto-Detect|CaInfo|""'
		echo 'Acquire::Languages "none";'
		echo 'APT::Sandbox::User "root";' # the cache may lie below a directory that only its owner may enter
		if [[ -f $certificates ]]; then
			cp "$certificates" "$root/var/lib/yade-ddem/certificates.crt"
			echo 'Acquire::https::CaInfo "/var/lib/yade-ddem/certificates.crt";'
		fi
	} >"$root/etc/apt/apt.conf.d/90host"
	cp -a /etc/apt/auth.conf /etc/apt/auth.conf.d "$root/etc/apt/" 2>/dev/null || true
	mkdir -p "$root/etc/dpkg/dpkg.cfg.d"
	printf '%s\n' force-unsafe-io 'path-exclude=/usr/share/doc/*' 'path-include=/usr/share/doc/*/copyright' \
		'path-exclude=/usr/share/man/*' 'path-exclude=/usr/share/info/*' 'path-exclude=/usr/share/locale/*' \
		>"$root/etc/dpkg/dpkg.cfg.d/90yade-ddem"
	printf '#!/bin/sh\nexit 101 # no services in here\n' >"$root/usr/sbin/policy-rc.d"
	chmod +x "$root/usr/sbin/policy-rc.d"
}

fetch_headers_in_root() {
	local version
	version=$(in_root dpkg-query -W -f '${source:Version}' yade)
	mkdir -p "$root/usr/src/yade"
	in_root env -C /usr/src/yade apt-get source --tar-only --download-only "yade=$version"
}

# in_root COMMAND…: a command of the set-up inside the root, without the caller's files.
in_root() { "$setup_dir/enter_root.sh" "$root" --system -- env LC_ALL=C.UTF-8 DEBIAN_FRONTEND=noninteractive "$@"; }
