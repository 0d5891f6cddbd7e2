#!/usr/bin/env bash
# Shows that a machine with nothing but git and make needs two commands: makes a minimal Debian 12
# in a folder, copies the working tree into it, and runs the commands there, without a terminal.
# Usage: sudo scripts/try_clean_machine.sh [DIR [COMMAND...]]
#   DIR       where the machine is made, anew each time; default /tmp/clean_machine. The bare system
#             is kept as DIR.tar for the next time.
#   COMMAND   default: "make demo" "make test"
# Needs root, debootstrap and this machine's own Debian mirror.
set -euo pipefail

source_dir=$(cd "$(dirname "$0")/.." && pwd)
machine=${1:-/tmp/clean_machine}
commands=("${@:2}")
[ ${#commands[@]} -gt 0 ] || commands=("make demo" "make test")
bare=$machine.tar

unmount() {
    local folder
    for folder in proc dev/pts; do
        if mountpoint --quiet "$machine/$folder"; then umount "$machine/$folder"; fi
    done
}
trap unmount EXIT
unmount # what a killed run left
rm -rf --one-file-system "$machine"

if [ ! -f "$bare" ]; then
    mirror=$(apt-get indextargets --format "\$(REPO_URI)" "Codename: bookworm" | head -n 1)
    debootstrap --variant=minbase --include=git,make bookworm "$machine" "$mirror"
    tar --create --file "$bare.part" --directory "$machine" .
    mv "$bare.part" "$bare"
    rm -rf "$machine"
fi
mkdir -p "$machine"
tar --extract --file "$bare" --directory "$machine"
cp /etc/resolv.conf /etc/hosts "$machine/etc/"
certificates= # those that this machine's way to the npm registry needs
if [ -n "${NODE_EXTRA_CA_CERTS:-}" ]; then
    certificates=/etc/npm_certificates.crt
    cp "$NODE_EXTRA_CA_CERTS" "$machine$certificates"
fi
mount -t proc proc "$machine/proc"
mkdir -p "$machine/dev/pts"
mount -t devpts -o newinstance,ptmxmode=0666 devpts "$machine/dev/pts" # terminals, as on any machine
ln --symbolic --force pts/ptmx "$machine/dev/ptmx"

# The working tree as git sees it, new files included, and the shared data beside it, if any.
home=$machine/root/insym
mkdir -p "$home/main"
git -C "$source_dir" ls-files -z --cached --others --exclude-standard |
    tar --create --directory "$source_dir" --null --ignore-failed-read --files-from - |
    tar --extract --directory "$home/main"
git init --quiet "$home/main"
if [ -d "$source_dir/../shared" ]; then cp -r "$source_dir/../shared" "$home/"; fi

for command in "${commands[@]}"; do
    echo "== $command"
    start=$SECONDS
    env --ignore-environment HOME=/root NODE_EXTRA_CA_CERTS="$certificates" PATH=/usr/sbin:/usr/bin:/sbin:/bin \
        chroot "$machine" bash -c "cd /root/insym/main && $command" </dev/null
    echo "== $command: $((SECONDS - start)) s"
done
