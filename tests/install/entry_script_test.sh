#!/usr/bin/env bash
# The entry script, run in a sandbox with only what it may use on the path: cmake, apt-get and the program are
# stand-ins that note how they were called.
# usage: entry_script_test.sh SOURCE WORKDIR
set -uo pipefail
source=$1 work=$2
failures=0

check() {  # check WHAT COMMAND…
  local what=$1; shift
  if ! "$@"; then
    printf 'FAILED: %s\n' "$what"
    cat "$work/err" 2>/dev/null
    failures=$((failures + 1))
  fi
}
equal() { [ "$1" = "$2" ] || { printf 'got "%s", want "%s"\n' "$1" "$2"; return 1; }; }
says() { grep -qF -- "$1" "$work/err"; }
stand_in() { cat >"$1"; chmod +x "$1"; }

# sandbox: a fresh source folder with the script in it, and a path.
sandbox() {
  local tool
  rm -rf "$work"
  mkdir -p "$work/a tree/cmake" "$work/bin" "$work/elsewhere"
  tree="$work/a tree"
  cp "$source/grainlaw" "$tree/grainlaw"
  cat >"$tree/cmake/packages.txt" <<'TXT'
# a comment
bash | cmd:bash | there
TXT
  for tool in awk bash cat chmod cp cut dirname env find flock grep head id mkdir mktemp nproc printf readlink rm rmdir sed sleep \
              stty tail tee touch tr true; do
    ln -s "$(type -P "$tool")" "$work/bin/$tool"
  done
  # A cmake that builds a program which tells how it was started, and notes when two of it run at a time.
  stand_in "$work/bin/cmake" <<SH
#!/bin/bash
printf '%s\n' "cmake \$*" >>"$work/calls"
mkdir "$work/busy" 2>/dev/null || touch "$work/overlap"
sleep 0.2
if [ "\$1" = -S ]; then
  printf 'CMAKE_HOME_DIRECTORY:INTERNAL=%s\nCMAKE_GENERATOR:INTERNAL=Ninja\n' "\$2" >"\$4/CMakeCache.txt"
  touch "\$4/build.ninja"
else
  mkdir -p "\$2/apps"
  printf '%s\n' '#!/bin/bash' 'printf "%s|" "\$PWD" "\$GRAINLAW_HOME" "\$@"' 'exit 7' >"\$2/apps/grainlaw"
  chmod +x "\$2/apps/grainlaw"
fi
rmdir "$work/busy" 2>/dev/null
if [ -e "$work/break" ]; then
  printf '%s\n' "[1/2] Building" "FAILED: thing.o" "thing.cpp:1: error: no such thing"; exit 1
fi
exit 0
SH
}

# run ARGS…: the script from another folder; output in out, err, and its status.
run() {
  (cd "$work/elsewhere" && env -i PATH="$work/bin" TERM=dumb "$tree/grainlaw" "$@") >"$work/out" 2>"$work/err" </dev/null
  status=$?
}

sandbox
run predict 'a file' -o b.csv
check "the program's status comes back" equal "$status" 7
check "the program runs in the user's folder, with the user's words" \
      equal "$(cat "$work/out")" "$work/elsewhere|$tree|predict|a file|-o|b.csv|"
check "the first run configures for release" grep -q -- '-DCMAKE_BUILD_TYPE=Release' "$work/calls"
rm "$work/calls"
run
check "without words it asks for help" equal "$(cat "$work/out")" "$work/elsewhere|$tree|--help|"
check "the second run does not configure" equal "$(grep -c -- ' -S ' "$work/calls")" 0
check "the second run says nothing of its own" equal "$(cat "$work/err")" ""

rm -f "$work/overlap"
(cd "$work/elsewhere" && env -i PATH="$work/bin" "$tree/grainlaw" one >/dev/null 2>&1) & first=$!
(cd "$work/elsewhere" && env -i PATH="$work/bin" "$tree/grainlaw" two >/dev/null 2>&1) & second=$!
wait $first $second
check "two at once build one after the other" test ! -e "$work/overlap"

touch "$work/break"
run simulate
check "a build that fails is status 1" equal "$status" 1
check "and shows the error" says "thing.cpp:1: error: no such thing"
check "and does not start the program" equal "$(cat "$work/out")" ""
rm "$work/break"

mv "$tree" "$work/moved"; tree=$work/moved
run report
check "a folder that was moved is configured anew" equal "$(cat "$work/out")" "$work/elsewhere|$tree|report|"
check "and says so" says "afresh"

sandbox
cat >>"$tree/cmake/packages.txt" <<'TXT'
libnowhere-dev | inc:no/where.hpp | not there
nowhere-bin | cmd:nowhere cmd:no-where | not there
TXT
run calibrate
check "what is missing without apt-get is status 2" equal "$status" 2
check "and is named" says "libnowhere-dev nowhere-bin"
check "and what is there is not" equal "$(grep -c 'bash' "$work/err")" 0
check "and nothing was built" test ! -e "$work/calls"

# As a user who is not root, with sudo: an apt-get that brings what it is asked for.
rm "$work/bin/id"
stand_in "$work/bin/id" <<<'#!/bin/bash
echo 1000'
stand_in "$work/bin/dpkg" <<<'#!/bin/bash'
stand_in "$work/bin/apt-get" <<SH
#!/bin/bash
printf '%s\n' "apt-get \$* frontend=\$DEBIAN_FRONTEND" >>"$work/calls"
case "\$*" in *nowhere-bin*) cp "\$0" "$work/bin/no-where"; mkdir -p "$work/prefix/include/no"
touch "$work/prefix/include/no/where.hpp" ;; esac
SH
run calibrate
check "without root or sudo it is status 2" equal "$status" 2
check "and tells the command" says "apt-get install libnowhere-dev nowhere-bin"
stand_in "$work/bin/sudo" <<SH
#!/bin/bash
printf '%s\n' "sudo \$1" >>"$work/calls"
[ "\$1" = -n ] && shift
exec "\$@"
SH
(cd "$work/elsewhere" && env -i PATH="$work/bin" CMAKE_PREFIX_PATH="/nowhere:$work/prefix" "$tree/grainlaw" calibrate) \
  >"$work/out" 2>"$work/err" </dev/null
check "with sudo it installs and goes on" equal "$(cat "$work/out")" "$work/elsewhere|$tree|calibrate|"
check "asking nothing" grep -q 'apt-get -y .* install .*libnowhere-dev nowhere-bin frontend=noninteractive' "$work/calls"
check "sudo asks nothing" equal "$(grep '^sudo' "$work/calls" | sort -u)" "sudo -n"
rm "$work/calls"
(cd "$work/elsewhere" && env -i PATH="$work/bin" CMAKE_PREFIX_PATH="$work/prefix" "$tree/grainlaw" calibrate) \
  >"$work/out" 2>"$work/err" </dev/null
check "once there, apt-get is left alone" equal "$(grep -c apt-get "$work/calls")" 0

rm -rf "$work"
if [ "$failures" -gt 0 ]; then printf '%s checks failed\n' "$failures"; exit 1; fi
printf 'all checks passed\n'
