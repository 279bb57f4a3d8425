# For scripts that source it, with "set -euo pipefail" and from the project's root: a bare system of this
# machine's release in the folder $root, which is removed when the script ends. Needs root, debootstrap, and
# the mirror that this machine's own apt uses.
# shellcheck shell=bash

script=$(basename "$0")
if [[ $(id -u) -ne 0 ]]; then
  echo "scripts/$script: expected root, for chroot; run it by sudo" >&2
  exit 2
fi
command -v debootstrap >/dev/null || { echo "scripts/$script: install debootstrap" >&2; exit 2; }

# shellcheck disable=SC1091
codename=$(. /etc/os-release && echo "$VERSION_CODENAME")
# shellcheck disable=SC2016
mirror=$(apt-get indextargets --format '$(CREATED_BY) $(CODENAME) $(REPO_URI)' |
  awk -v codename="$codename" '$1 == "Packages" && $2 == codename { print $3; exit }')
if [[ -z $mirror ]]; then
  echo "scripts/$script: no mirror of $codename among apt's sources" >&2
  exit 1
fi

root=$(mktemp -d)
chmod 755 "$root"
leave() {
  if mountpoint -q "$root/proc"; then umount "$root/proc"; fi  # debootstrap leaves it behind
  rm -rf --one-file-system "$root"
}
trap leave EXIT
say() { printf '\n== %s\n' "$*"; }
inside() { chroot "$root" env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/tmp LC_ALL=C.UTF-8 \
  DEBIAN_FRONTEND=noninteractive "$@"; }
# What apt keeps for itself is not counted.
size() { du -sm --one-file-system --exclude="$root/var/cache/apt" --exclude="$root/var/lib/apt" "$root" | cut -f1; }
# shellcheck disable=SC2016
installed() { inside dpkg-query --show --showformat='${binary:Package}\n' | sort; }
install() {
  inside apt-get install --yes -qq --no-install-recommends "$@" >"$root/tmp/apt.log" 2>&1 ||
    { cat "$root/tmp/apt.log" >&2; return 1; }
}

say "a bare $codename"
debootstrap --variant=minbase "$codename" "$root" "$mirror" >/dev/null
