#!/usr/bin/env bash
# clean_machine.sh DEB: a Debian with nothing but its minimal packages is made in a folder; DEB is installed there, the demonstration runs, and DEB is purged.
# Says how long each took. Fails when installing and running takes over two minutes, when the demonstration does not pass or does not verify, or when the purge
# leaves a file. Needs root, debootstrap and Debian's mirror; nothing of this machine is changed.
set -euo pipefail
deb=$(realpath "$1")
root=$(mktemp -d)
chmod 755 "$root"
mounted=()
leave() {
  for place in "${mounted[@]}"; do umount -l "$place"; done
  rm -rf --one-file-system "$root"
}
trap leave EXIT
debootstrap --variant=minbase bookworm "$root" >"$root.log" 2>&1 || { tail -5 "$root.log"; exit 1; }
rm -f "$root.log"
for place in proc dev; do
  mount --rbind "/$place" "$root/$place"
  mount --make-rslave "$root/$place"
  mounted=("$root/$place" "${mounted[@]}")
done
cp /etc/resolv.conf "$root/etc/resolv.conf"
cp -r /etc/apt/apt.conf.d/. "$root/etc/apt/apt.conf.d/"  # a proxy, when there is one
cp "$deb" "$root/tmp/cavum.deb"
inside() { chroot "$root" env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root DEBIAN_FRONTEND=noninteractive "$@"; }
inside apt-get update -q >/dev/null
find_files() { (cd "$root" && find . -xdev -path ./proc -prune -o -path ./dev -prune -o -path ./tmp -prune -o -path ./root -prune -o -path ./var/cache -prune -o -path ./var/log -prune -o \
  -path ./var/lib/apt -prune -o -path ./var/lib/dpkg -prune -o -print) | sort; }
find_files >"$root/tmp/before"
begin=$SECONDS
inside apt-get install -q -y --no-install-recommends /tmp/cavum.deb >"$root/tmp/apt.log" 2>&1 || { tail -20 "$root/tmp/apt.log"; exit 1; }
echo "installed after $((SECONDS - begin)) s"
inside sh -c 'cd /root && cavum exam --json > result.json && cavum replay cavum-demonstration-*.cavum --verify'
took=$((SECONDS - begin))
python3 - "$root/root/result.json" <<'PY'
import json, sys
result = json.load(open(sys.argv[1]))
assert result["verdict"] == "pass", result["verdict"]
print(f"graded: {result['verdict']}")
PY
ls "$root"/root/cavum-demonstration-*.html >/dev/null
echo "from apt install to a graded, verified demonstration: $took s"
inside sh -c 'apt-get purge -q -y cavum && apt-get autoremove --purge -q -y' >"$root/tmp/purge.log" 2>&1 || { tail -20 "$root/tmp/purge.log"; exit 1; }
find_files >"$root/tmp/after"
left=$(comm -13 "$root/tmp/before" "$root/tmp/after" | grep -i cavum || true)
[ -z "$left" ] || { printf 'the purge left:\n%s\n' "$left"; exit 1; }
echo "purged; $(comm -13 "$root/tmp/before" "$root/tmp/after" | wc -l) files of other packages' own making are left"
comm -13 "$root/tmp/before" "$root/tmp/after" | head -20
[ "$took" -le 120 ] || { echo "longer than two minutes"; exit 1; }
