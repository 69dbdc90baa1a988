#!/usr/bin/env bash
# Brings the template cavum.pot, and the catalogues beside it, up to what the sources say. --check: changes nothing, and exits with 1 when something would change,
# or when a message of a catalogue is missing or only guessed (fuzzy). Sources are those that sources.txt lists; what is not there stays English.
#   ui/report        what stands in tr, trn, said and Error, in ui/office also in error_reply; of its figures, all sentences
#   other rooms      all their sentences: they are English, and are translated where they are shown; words.txt has the single words that are shown
set -euo pipefail
cd "$(dirname "$0")"
here=$PWD
root=$(cd ../.. && pwd)
new=$(mktemp -d)
trap 'rm -rf "$new"' EXIT
shopt -s globstar nullglob

sources() { # FOLDERS' PREFIX
  while read -r line; do
    case $line in
      '' | '#'*) ;;
      $1*) (cd "$root" && for f in $line/*.h $line/*.cpp; do echo "$f"; done; [ ! -f "$root/$line" ] || echo "$line") ;;
    esac
  done <sources.txt | sort -u
}
extract() { # OUT LANGUAGE KEYWORDS...; names of files from stdin
  local out=$1 language=$2
  shift 2
  (cd "$root" && xgettext --language="$language" --from-code=UTF-8 --no-wrap --no-location --sort-output "$@" \
    --force-po --add-comments=translators: --files-from=- --output="$out" 2>>"$new/warnings") || { cat "$new/warnings" >&2; exit 2; }
}
{ sources engine; sources scenarios; sources grading; sources ui/station; sources ui/verbs; sources ui/report/figures; } >"$new/below"
{ sources ui/report | grep -v "^ui/report/figures/"; sources ui/office; } >"$new/above"
(cd "$root" && ls ui/report/page/src/*.ts ui/office/page/src/*.ts) >"$new/page"
sed -n 's/^\([^#].*\)$/said("\1")/p' words.txt >"$new/words.cpp"
extract "$new/all-below.pot" C++ --extract-all <"$new/below"
awk 'BEGIN { RS = ""; ORS = "\n\n" } NR == 1 || !/msgid ""\nmsgstr ""$/' "$new/all-below.pot" >"$new/once.pot" && mv "$new/once.pot" "$new/all-below.pot"  # empty texts
extract "$new/words.pot" C++ --keyword --keyword=said:1 <<<"$new/words.cpp"
extract "$new/above.pot" C++ --keyword --keyword=tr:1 --keyword=trn:1,2 --keyword=said:1 --keyword=msg:1 --keyword=msgn:1,2 --keyword=Error:2 --keyword=error_reply:2 <"$new/above"
extract "$new/advice.pot" C++ --keyword --keyword=Error:3 <"$new/above"  # one place of a call in one run
extract "$new/all-places.pot" C++ --keyword --keyword=Error:1 <"$new/above"
sed -i 's/charset=CHARSET/charset=UTF-8/' "$new/all-places.pot"
extract "$new/page.pot" JavaScript --keyword '--keyword=tr:1,"page"' '--keyword=said:1,"page"' <"$new/page"  # the comment says that the page needs it
# what makes pictures, files and names of its texts is no sentence: tags, assignments, one word without a capital, no word at all
no_sentence='[<>]|[a-z_]=|^[a-z_.]+ = |^--[a-z-]+ ?$|'$'\r''|^##|^[#$]|^%[A-Z]|^0123|^(cavum|cavum [a-z]+( [a-z]+)?)$|^zones/|^\{\{|^#[0-9a-f]{6}$|^[a-z0-9_./:*{}-]+$|^[^a-z]+$|^([^a-zA-Z]+[a-zA-Z]?[^a-zA-Z]*|[a-zA-Z])$|^\[\"|uniform |^in vec3 |void main|^%[-.0-9]*[a-z]$|^student-|^[^ ]*\.(h|toml|cvt|json)$|^(measure_marking|moments_of_measure|measures): |^/|^\{\}/|^\{\}o\{\}ly$|^(SELECT|INSERT|UPDATE|DELETE|CREATE|PRAGMA|ALTER|DROP|ORDER BY|WHERE) |^[a-z]+[A-Z][A-Za-z]+$|^(unsigned|signed|short) (int|char|short)$|ATTRS?\{|^: [a-z_.]+$|^(entr\{\}|ies \{\}|y \{\}$|used \{\}|closed \{\}|not-begun |--ticket |session,candidate)|^%[0-9]d-|^cavum (begin|station request|ticket) [0-9]$|^libHD|"(commands|inverse3)":|^seq, |^&[a-z]+;$|^abcdef|^%x:|^\\\\u|^CMakeLists|^SQLite format|-XXXXXX$|^cavum \{\} key|^https:|^N·s$|^\[\{\}|^give a word or a number$|^each kind has a name$|^a field of the request has no limit$|^the kind has another number of values$'
msggrep --invert-match --no-wrap --msgid --extended-regexp --regexp="$no_sentence" "$new/all-below.pot" >"$new/below.pot"
msggrep --invert-match --no-wrap --msgid --extended-regexp --regexp="$no_sentence" "$new/all-places.pot" >"$new/places.pot"
# the page stands first: what it shares with C++ must keep the comment that the page needs it
msgcat --use-first --no-wrap --sort-output "$new/page.pot" "$new/below.pot" "$new/words.pot" "$new/above.pot" "$new/places.pot" "$new/advice.pot" |
  sed -e '/^"POT-Creation-Date:/d' -e '/^#, c-format$/d' -e '/^#, javascript-format$/d' -e 's/^"Project-Id-Version: PACKAGE VERSION/"Project-Id-Version: cavum/' >"$new/cavum.pot"
failed=0
if [ "${1:-}" = --check ]; then
  cmp -s "$new/cavum.pot" cavum.pot || { echo "cavum.pot is not what the sources say; run data/languages/extract.sh" >&2; diff cavum.pot "$new/cavum.pot" | head -40 >&2; failed=1; }
else
  cp "$new/cavum.pot" cavum.pot
fi
for po in *.po; do
  if [ "${1:-}" != --check ]; then
    msgmerge --quiet --update --backup=none --no-wrap --no-fuzzy-matching --no-location --sort-output "$po" cavum.pot
  fi
  missing=$({ msgattrib --untranslated --no-wrap "$po"; msgattrib --only-fuzzy --no-wrap "$po"; } | grep -c '^msgid "..*' || true)
  [ "$missing" = 0 ] || { echo "$po: $missing messages are missing" >&2; failed=1; }
  msgcmp --use-untranslated "$po" cavum.pot >&2 || failed=1
done
exit $failed
