#!/usr/bin/env bash
# container.sh DEB SESSION...: the image of ui/install/Containerfile is built with DEB, sits the demonstration exam and replays each SESSION in it. Prints the
# seconds of each. Fails when the demonstration does not pass or a replay does not verify. Needs podman, and root where no registry is reached: the base image is
# then made by debootstrap. PODMAN names another command, as PODMAN="podman --runtime runc" where crun knows the machine's cgroups not.
set -euo pipefail
source=$(cd "$(dirname "$0")/../.." && pwd)
deb=$(realpath "$1")
shift
read -r -a podman <<<"${PODMAN:-podman}"
work=$(mktemp -d)
trap 'rm -rf --one-file-system "$work"' EXIT
base=debian:bookworm-slim
# hard limits no higher than ours: only root may raise them, and not everywhere
limits=(--network=host --ulimit nofile=1024:1024 --ulimit nproc=1000:1000)
if ! "${podman[@]}" image exists "$base" && ! timeout 60 "${podman[@]}" pull -q "docker.io/library/$base" >/dev/null 2>&1; then
  debootstrap --variant=minbase bookworm "$work/root" >"$work/log" 2>&1 || { tail -5 "$work/log"; exit 1; }
  cp -r /etc/apt/apt.conf.d/. "$work/root/etc/apt/apt.conf.d/"  # a proxy, when there is one
  tar -C "$work/root" -c . | "${podman[@]}" import - "$base" >/dev/null 2>&1
  rm -rf --one-file-system "$work/root"
fi
mkdir "$work/context"
cp "$deb" "$work/context/"
begin=$SECONDS
"${podman[@]}" build -q "${limits[@]}" -t cavum -f "$source/ui/install/Containerfile" "$work/context" >"$work/log" 2>&1 || { tail -20 "$work/log"; exit 1; }
echo "image built after $((SECONDS - begin)) s"
mkdir -m 777 "$work/sat"
inside() { "${podman[@]}" run --rm "${limits[@]}" "$@"; }
inside -v "$work/sat:/work" -w /work cavum exam --json >"$work/result.json"
python3 -c 'import json, sys; verdict = json.load(open(sys.argv[1]))["verdict"]; print("graded:", verdict); sys.exit(verdict != "pass")' "$work/result.json"
for session in "$work"/sat/*.cavum "$@"; do
  folder=$(dirname "$(realpath "$session")")
  inside -v "$folder:/work:ro" -w /work cavum replay "$(basename "$session")" --verify | head -1
done
echo "image, demonstration and replays: $((SECONDS - begin)) s"
