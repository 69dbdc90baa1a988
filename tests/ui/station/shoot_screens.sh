#!/usr/bin/env bash
# Pictures of every screen of the station, for eyes, and beside each what it says, NAME.txt: shoot_screens.sh FOLDER [WIDTHxHEIGHT LANGUAGE]. Without a
# size: at 1280x800 and 3840x2160 in English and German, a folder each. Needs xvfb-run; takes some minutes each.
#   tests/ui/station/shoot_screens.sh build/release/pictures/all
#   CAVUM=build/release/cavum   another program
set -euo pipefail
[ $# -eq 1 ] || [ $# -eq 3 ] || { sed -n 2,5p "$0" >&2; exit 2; }
if [ $# -eq 1 ]; then
  for size in 1280x800 3840x2160; do for language in en de; do "$0" "$1/$language-$size" "$size" "$language"; done; done
  exit
fi
here=$(cd "$(dirname "$0")/../../.." && pwd)
cavum=$(realpath "${CAVUM:-$here/build/release/cavum}")
mkdir -p "$1"
out=$(realpath "$1")
size=$2 language=$3
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
export CAVUM_HOME=$work/home LANGUAGE=$language CAVUM_DATA=$here/data
mkdir "$CAVUM_HOME"
task=$here/data/scenarios/class_1.toml
block=$here/data/scenarios/slot.toml

sit() { # NAME OPTIONS: the script comes from standard input; in a window of that size
  sed 's/^picture \(.*\)/&\nwords \1/' >"$work/script"
  xvfb-run -a -s "-screen 0 ${size}x24" "$cavum" --language "$language" station "${@:2}" --effects 2 --width "${size%x*}" --height "${size#*x}" \
    --script "$work/script" --pictures "$out" >"$work/said" 2>&1 || { echo "$1:" && cat "$work/said"; } >&2
}

to_exam="sleep 0.3
picture 01-sign-in
type K7
key enter
wait preparing
picture 02-preparing
wait device-check
picture 03-device-check"
sit exam "$task" --device simulated --out "$work/exam.cavum" <<END
$to_exam
go briefing
sleep 0.3
picture 04-briefing
key enter
wait exam
until 8
picture 05-exam
key 2
sleep 0.5
picture 06-from-the-side
key m
sleep 0.3
picture 07-mirror
key m
key t
sleep 0.3
picture 08-both-eyes
key t
key escape
sleep 0.5
picture 09-finished
key enter
wait grading
picture 10-grading
wait result
sleep 0.5
picture 11-result
key enter
END
sit replay --replay "$work/exam.cavum" <<END
wait replay
key end
sleep 3
picture 12-replay
key escape
END
sit tutorial "$task" --tutorial --out "$work/tutorial.cavum" <<END
sleep 0.3
picture 13-sign-in-to-practise
go device-check
sleep 1
key space 0.6
go briefing
key enter
wait exam
sleep 1
picture 14-tutorial
key u
sleep 0.3
picture 15-practice
key c
hold pagedown
sleep 2
release pagedown
picture 16-practice-at-the-tooth
key escape
sleep 0.3
key enter
wait result
key enter
END
sed 's/^time_limit_s/pauses = { count = 1, longest_s = 60, button = 1 }\n&/' "$block" >"$work/paused.toml"
sit contrast "$work/paused.toml" --tooth "$here/data/teeth/block.cvt" --device mouse --high-contrast --left-handed --text-scale 1.3 --out "$work/paused.cavum" <<END
type K7
go device-check
sleep 1
key space 0.6
go briefing
sleep 0.3
picture 17-briefing-contrast
key enter
wait exam
until 1
picture 18-exam-contrast-left-handed
key p
sleep 0.5
picture 19-pause
key p
sleep 0.3
key escape
sleep 0.3
key enter
wait result
sleep 0.3
picture 20-result-contrast
key enter
END
echo overthelake | "$cavum" station --set-supervisor-code >/dev/null
sit kiosk "$block" --device simulated --kiosk --out "$work/kiosk.cavum" <<END
type K7
go device-check
go briefing
key enter
wait exam
until 2
key f4
close
sleep 0.5
picture 21-leave
key escape
sleep 0.5
picture 22-tried-to-leave
key escape
sleep 0.5
key enter
wait result
close
sleep 0.5
type overthelake
key enter
END
cp "$task" "$work/mine.toml"
sit author --author "$work/mine.toml" <<END
wait author
sleep 6
picture 23-author
key l
sleep 1
picture 24-author-landmarks
close
END
sit self-check "$block" --device inverse3 --out "$work/none.cavum" <<END
type K7
key enter
wait self-check
sleep 0.5
picture 25-self-check
close
END
# the tooth from occlusal, buccal, lingual, mesial and distal: untouched, opened, finished
"$cavum" exam "$task" --candidate K7 --operator expert --quiet --out "$work/expert.cavum" >"$work/said"
sides() { for side in 1 2 3 4 5; do printf 'key %s\nsleep 0.5\npicture %s-%s\n' $side "$1" $side; done; }
sit tooth --replay "$work/expert.cavum" <<END
wait replay
key h
sleep 2
$(sides 31-untouched)
hold shift
key .
release shift
sleep 5
$(sides 32-opened)
key end
sleep 5
$(sides 33-finished)
key escape
END
ls "$out"
