# shellcheck shell=bash disable=SC2016 # $(…) in single quotes is for apt and dpkg
# GPL v2 or later, see LICENSE.
# The place where YADE runs: this machine when its YADE is new enough, else the Debian 13 root.
# The rest of the launcher does not care which.

# choose_environment: sets root (empty: this machine), and with it the cache's directories.
choose_environment() {
	local version
	version=$(host_yade_version)
	if version_at_least "$version" "$YADE_MINIMUM"; then
		root=
		find_cache "$(os_release ID)$(os_release VERSION_ID)"
	else
		find_cache debian13
		root=$cache_dir/debian13-$(dpkg --print-architecture 2>/dev/null || uname -m)
		require_root_rights
	fi
	readonly root
}

# prepare_environment: YADE, compiler, libraries, headers and the packages in $needed are there afterwards, and stay
# while the locks are held.
prepare_environment() {
	share_environment
	if environment_is_ready; then return; fi
	own_environment
	make_environment
	share_environment
}

environment_is_ready() {
	find_yade_source
	[[ $yade_source ]] || return
	if [[ $root ]]; then root_is_ready; else [[ -z $(missing_on_host) ]]; fi
}

make_environment() {
	if [[ $root ]]; then
		make_debian_root
		install_needed
	else
		install_host_packages
		get_host_headers
	fi
	find_yade_source
}

# find_yade_source: sets yade_source, the source tree or archive of this YADE, for the headers that Debian does not
# package; empty when there is none yet.
find_yade_source() {
	local version
	yade_source=${YADE_SOURCE_DIR:-}
	if [[ ! $yade_source && $root ]]; then
		yade_source=$(newest "$root"/usr/src/yade/yade_*.orig.tar.*)
	elif [[ ! $yade_source ]] && version=$(host_source_version); then
		yade_source=$(newest "$(host_headers)"/yade_*.orig.tar.* /usr/src/yade/yade_"${version%-*}".orig.tar.*)
	fi
	yade_source=${yade_source#"$root"}
}

host_source_version() { dpkg-query -W -f '${source:Version}' yade 2>/dev/null; }

host_headers() { echo "$cache_dir/headers-$(host_source_version)"; }

missing_on_host() {
	[[ -x $(command -v dpkg-query) ]] || return 0 # not a Debian: CMake says what is missing
	# shellcheck disable=SC2046 # one word a package
	missing_packages $(listed_packages) "${needed[@]}"
}

install_host_packages() {
	local missing
	missing=$(missing_on_host)
	[[ $missing ]] || return 0
	((EUID == 0)) || fail "these packages are missing: sudo apt-get install --no-install-recommends $missing"
	# shellcheck disable=SC2086 # one word a package
	phase "Debian packages" apt_get install -y --no-install-recommends $missing
}

# Its source archive has them, in exactly the version of the program, over apt's chain of signatures.
get_host_headers() {
	local version
	find_yade_source
	[[ ! $yade_source ]] || return 0
	version=$(host_source_version) \
		|| fail "this YADE is not a Debian package: name its source tree, of the same version," \
			"in the environment variable YADE_SOURCE_DIR"
	phase "YADE's headers" fetch_host_headers "$version" "$(host_headers)"
}

# With lists of its own below the cache: works without root, and leaves this machine's apt as it is.
fetch_host_headers() {
	local version=$1 directory=$2 apt=$cache_dir/apt
	as_caller mkdir -p "$apt/lists/partial" "$apt/archives/partial" "$directory.unfinished"
	apt-get indextargets --format 'deb-src [signed-by=$(SIGNED_BY)] $(REPO_URI) $(RELEASE) $(COMPONENT)' \
		'Created-By: Packages' \
		| sed 's/ \[signed-by=\(\$(SIGNED_BY)\)\{0,1\}\]//' | sort -u | as_caller tee "$apt/sources.list"
	local options=(
		-o "Dir::Etc::SourceList=$apt/sources.list" -o Dir::Etc::SourceParts=/dev/null
		-o "Dir::State::Lists=$apt/lists" -o "Dir::Cache=$apt" -o APT::Sandbox::User=
	)
	as_caller apt-get "${options[@]}" update || return
	(cd "$directory.unfinished" && as_caller apt-get "${options[@]}" \
		source --tar-only --download-only "yade=$version") || return
	as_caller mv "$directory.unfinished" "$directory"
	rm -rf "$apt"
}

# newest FILE…: the highest version among those that exist.
newest() {
	local file
	for file in "$@"; do [[ ! -f $file ]] || printf '%s\n' "$file"; done | sort -V | tail -n 1
}

# exec_inside COMMAND…: becomes the command, inside the environment, as the caller, with the caller's directory, files,
# variables and terminal.
exec_inside() {
	if [[ $root ]]; then
		exec "$setup_dir/enter_root.sh" "$root" --caller "$caller_uid" "$caller_gid" "$caller_home" \
			"$checkout" "$cache_dir" "${visible[@]}" -- "$@"
	elif ((caller_uid != EUID)); then
		exec "$setup_dir/as_user.sh" "$caller_uid" "$caller_gid" "$caller_home" "$@"
	else
		exec "$@"
	fi
}

# inside COMMAND…: the same, and comes back.
inside() { (exec_inside "$@"); }
