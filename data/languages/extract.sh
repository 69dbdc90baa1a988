#!/usr/bin/env bash
# Brings the template cavum.pot, and the catalogues beside it, up to what the sources say. --check: changes nothing, and exits with 1 when something would change,
# or when a message of a catalogue is missing or only guessed (fuzzy).
#   C++    what stands in msg, msgn, tr, trn and noop, in all files of engine, scenarios, grading and ui
#   tasks  what stands as title, sentence or instruction in data/tasks, and as title of a criterion in data/scenarios
#   pages  what stands in tr and noop
set -euo pipefail
export LC_ALL=C.UTF-8  # what a letter is, and the order
cd "$(dirname "$0")"
root=$(cd ../.. && pwd)
new=$(mktemp -d)
trap 'rm -rf "$new"' EXIT

extract() { # OUT LANGUAGE KEYWORDS...; names of files from stdin
  local out=$1 language=$2
  shift 2
  (cd "$root" && xgettext --language="$language" --from-code=UTF-8 --no-wrap --no-location --sort-output --keyword "$@" \
    --force-po --add-comments=translators: --files-from=- --output="$out" 2>>"$new/warnings") || { cat "$new/warnings" >&2; exit 2; }
}
git -C "$root" ls-files {engine,scenarios,grading,ui}/{'*.h','*.cpp','*.inc'} >"$new/sources"
git -C "$root" ls-files ui/{report,office}/page/src/'*.ts' >"$new/page"
extract "$new/sources.pot" C++ --keyword=msg:1 --keyword=msgn:1,2 --keyword=tr:1 --keyword=trn:1,2 --keyword=noop:1 <"$new/sources"
# the tables of findings and damages are macros, which xgettext passes over
sed -e '/^#define/d' -e 's/ \\$//' "$root"/grading/{result,records}/finding.h "$root/engine/session/damage.h" >"$new/findings.h"
extract "$new/findings.pot" C++ --keyword=FINDING:3 --keyword=KIND:3 --keyword=DAMAGE:3 <<<"$new/findings.h"
extract "$new/page.pot" JavaScript '--keyword=tr:1,"page"' '--keyword=noop:1,"page"' <"$new/page"  # the comment says that the page needs it
# titles, sentences and instructions of tasks, a line each, their gaps without names; and what criteria are called in them and in the scenarios that ship
{
  grep -hE '^ *(title|what|what_front|chosen|chosen_front|instruction) = ' "$root"/data/tasks/*.toml
  awk '/^\[/ { criterion = /rubric.criteria/ } criterion && /^title = /' "$root"/data/scenarios/*.toml
} | sed -E 's/^[^=]*= //; s/\{[a-z_]+\}/{}/g' | grep -oE '"[^"]+"' | sed 's/.*/noop(&)/' >"$new/tasks.h"
extract "$new/tasks.pot" C++ --keyword=noop:1 <<<"$new/tasks.h"
# the page stands first: what it shares with C++ must keep the comment that the page needs it
msgcat --use-first --no-wrap --sort-output "$new/page.pot" "$new/sources.pot" "$new/findings.pot" "$new/tasks.pot" |
  sed -e '/^"POT-Creation-Date:/d' -e '/^#, c-format$/d' -e '/^#, javascript-format$/d' -e 's/^"Project-Id-Version: PACKAGE VERSION/"Project-Id-Version: cavum/' >"$new/all.pot"
# nothing to translate: no letter outside gaps, such as "{}: {}" or "–"; but "." is the decimal sign
msggrep --invert-match --no-wrap --msgid --extended-regexp --regexp='^(\{[^}]*\}|[^[:alpha:]{.]|([^[:alpha:]{]|\{[^}]*\}){2,})$' "$new/all.pot" >"$new/cavum.pot"
failed=0
if [ "${1:-}" = --check ]; then
  cmp -s "$new/cavum.pot" cavum.pot || { echo "cavum.pot is not what the sources say; run data/languages/extract.sh" >&2; diff cavum.pot "$new/cavum.pot" | head -40 >&2; failed=1; }
else
  cp "$new/cavum.pot" cavum.pot
fi
for po in *.po; do
  if [ "${1:-}" != --check ]; then
    msgmerge --quiet --update --backup=none --no-wrap --no-fuzzy-matching --no-location --sort-output "$po" cavum.pot
    msgattrib --no-obsolete --no-wrap --sort-output --output-file="$po" "$po"
  fi
  missing=$({ msgattrib --untranslated --no-wrap "$po"; msgattrib --only-fuzzy --no-wrap "$po"; } | grep -c '^msgid "..*' || true)
  [ "$missing" = 0 ] || { echo "$po: $missing messages are missing" >&2; failed=1; }
  msgcmp --use-untranslated "$po" cavum.pot >&2 || failed=1
done
exit $failed
