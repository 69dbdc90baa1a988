#!/usr/bin/env bash
# run.sh CMAKE BUILD_DIR SOURCE_DIR: installs into a new folder, moves that, and runs the demonstration, its replay, the manual page and the completion there.
set -euo pipefail
cmake=$1 build=$2 source=$3
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
"$cmake" --install "$build" --prefix "$folder/first" >"$folder/log" 2>&1 || { cat "$folder/log"; exit 1; }
mv "$folder/first" "$folder/moved"
cd "$folder"
unset CAVUM_DATA
export HOME=$folder/home CAVUM_HOME=$folder/home
cavum=$folder/moved/bin/cavum
"$cavum" exam --json >result.json
python3 - <<'PY'
import json
result = json.load(open("result.json"))
assert result["verdict"] == "pass", result["verdict"]
PY
[ -s cavum-demonstration-*.html ] || { echo "the demonstration wrote no report"; exit 1; }
"$cavum" replay cavum-demonstration-*.cavum --verify
for place in "$source" "$build"; do
  if grep -aqF "$place" "$cavum"; then echo "the program names the folder that it was built in: $place"; exit 1; fi
done
for file in share/man/man1/cavum.1 share/bash-completion/completions/cavum share/applications/cavum.desktop lib/udev/rules.d/60-cavum.rules share/cavum/schemas/result.schema.json share/doc/*/copyright; do
  [ -s moved/$file ] || { echo "not installed: $file"; exit 1; }
done
for verb in $("$cavum" --help | awk '/^  [a-z]/ {print $1}'); do
  grep -qF "cavum ${verb//-/\\-}" moved/share/man/man1/cavum.1 || { echo "the manual page lacks the verb $verb"; exit 1; }
done
bash -c 'source moved/share/bash-completion/completions/cavum; COMP_WORDS=(cavum ledger can); COMP_CWORD=2; _cavum; [[ " ${COMPREPLY[*]} " == *" cancel "* ]]' ||
  { echo "the completion does not know cavum ledger cancel"; exit 1; }
echo "installed, moved, and run"
