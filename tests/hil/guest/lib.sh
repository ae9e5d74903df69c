# SPDX-License-Identifier: Apache-2.0
# What the scenarios share. They print facts, a line each; judge.py knows what they must be.
#   FACT NAME VALUE         JSON NAME STATUS {...}, of a command with --json
# BUS says where the device is: vhci (USB/IP), functionfs, or real, a device on the machine that runs this.
# shellcheck shell=bash
project=${PROJECT:-/project}
scratch=${SCRATCH:-/tmp}
device=${DEVICE:-usb}
scene=scene.toml

say() { echo "== $* ($(cut -d' ' -f1 /proc/uptime) s)"; }
fact() { echo "FACT $1 ${*:2}"; }
# json NAME COMMAND...
json() {
  "${@:2}" >"$scratch/out" 2>"$scratch/err"
  echo "JSON $1 $? $(tr -d '\n' <"$scratch/out")"
  sed 's/^/  /' "$scratch/err"
}
# status NAME COMMAND...: its exit status as a fact, what it says as a comment
status() {
  "${@:2}" >"$scratch/said" 2>&1
  fact "$1" $?
  sed 's/^/  /' "$scratch/said"
}
# measure NAME OPTION...
measure() { json "$1" "${render[@]}" "${@:2}"; }
render=(palpate run "$scene" --device "$device" ${CPU:+--cpu "$CPU"} --json --quiet)

# until_true COMMAND...: two seconds at most
until_true() {
  for _ in {1..40}; do "$@" >/dev/null 2>&1 && return; sleep 0.05; done
  echo "gave up waiting for: $*"
  return 1
}

# mark, let_go NAME: now, and when the simulated device first had no force after that, by the time of day and since the last command
# that it got. Nothing is printed in between: it takes time.
mark() { marked=$EPOCHREALTIME; }
let_go() {
  fact "$1_at" "$marked"
  fact "$1_let_go" "$(awk -v at="$marked" '$1 > at && /no force/ { print $1; exit }' "$scratch/sim.log")"
  fact "$1_after_us" "$(awk -v at="$marked" '$1 > at && /no force .* us after/ { print $5; exit }' "$scratch/sim.log")"
}

hogs=()
hogs_on() {
  for _ in 1 2 $(seq "$(nproc)"); do (while :; do :; done) & hogs+=($!); done
  dd if=/dev/zero of=/dev/null bs=1M 2>/dev/null & hogs+=($!)
}
hogs_off() { kill "${hogs[@]}"; wait "${hogs[@]}" 2>/dev/null; hogs=(); }

# Whether a process has a thread with real-time priority: policy is field 41.
is_realtime() { cat /proc/"$1"/task/*/stat 2>/dev/null | awk '$41 == 1 { found = 1 } END { exit !found }'; }
# measure_beside_hogs NAME OPTION...: hogs from the loop's first ticks on. What makes it ready is not measured.
measure_beside_hogs() {
  "${render[@]}" "${@:2}" >"$scratch/beside_hogs" 2>"$scratch/err" & local run=$!
  until_true is_realtime $run
  hogs_on
  wait $run
  local status=$?
  hogs_off
  echo "JSON $1 $status $(tr -d '\n' <"$scratch/beside_hogs")"
  sed 's/^/  /' "$scratch/err"
}

sudo() { "$@"; }
# Does all that doctor says.
fix() { cd "$project" && eval "$(palpate doctor | sed -n 's/^ *fix: *//p')" >"$scratch/fixed"; cd - >/dev/null; }
# Does what doctor says about the threads that serve USB.
raise_threads() { eval "$(palpate doctor | sed -n '/^fix   usb_threads/,/fix:/s/.*fix: *//p')"; }

is_there() { palpate devices --json | grep -q '"ready"'; }

simulator=
# simulate OPTION...: below the loop, which a device that is hardware does not hold up, and above everything else
simulate() {
  : >"$scratch/sim.log"
  case $BUS in
    vhci) chrt -f 79 palpate-sim --scene "$scene" "$@" >>"$scratch/sim.log" 2>&1 & ;;
    functionfs) PALPATE_SIM=palpate-sim chrt -f 79 "$project/tools/gadget" --scene "$scene" "$@" >>"$scratch/sim.log" 2>&1 & ;;
  esac
  simulator=$!
}
plug_in() {
  [ "$BUS" != vhci ] || usbip attach -r 127.0.0.1 -b 1-1
  until_true is_there
}
unplug() { usbip detach -p 0 >/dev/null 2>&1; }

# device_up OPTION...: a device that is ready, and the kernel as REALTIME.md wants it unless THREADS is "ordinary"
device_up() {
  case $BUS in
    real) return ;;
    vhci) modprobe vhci-hcd; simulate "$@"; until_true grep -q "simulated device" "$scratch/sim.log" ;;
    functionfs) modprobe dummy_hcd; simulate "$@"; until_true grep -q bound "$scratch/sim.log" ;;
  esac
  plug_in
  [ "${THREADS:-raised}" = ordinary ] || raise_threads
}
