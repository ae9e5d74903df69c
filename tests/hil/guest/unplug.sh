# SPDX-License-Identifier: Apache-2.0
# The device goes while the loop renders, in several ways; each time it comes back, and the next run renders.
. ./lib.sh

# lose NAME COMMAND...: does it while a run renders
lose() {
  say "$1"
  : >"$scratch/sim.log"
  "${render[@]}" --rate 1000 --seconds 1.2 >"$scratch/run" 2>"$scratch/run.err" & local run=$!
  until_true grep -q "active, force" "$scratch/sim.log"
  sleep 0.3
  mark
  "${@:2}"
  wait $run
  echo "JSON $1 $? $(tr -d '\n' <"$scratch/run")"
  sed "s/^/  /" "$scratch/run.err"
  let_go "$1"
}
# back NAME COMMAND...
back() {
  "${@:2}"
  until_true is_there
  raise_threads
  measure "$1_again" --rate 1000 --seconds 0.4
}
own() { ls -d /sys/bus/usb/devices/*:1.0 | while read -r interface; do
  [ "$(cat "$interface/bInterfaceSubClass")" != 50 ] || echo "${interface%:*}"
done; }
write() { echo "$2" >"$1"; }

device_up --rate 1000 --log
if [ "$BUS" = vhci ]; then
  lose detached unplug
  back detached usbip attach -r 127.0.0.1 -b 1-1
  lose deauthorised write "$(own)/authorized" 0
  back deauthorised write "$(ls -d /sys/bus/usb/devices/*-1/authorized | head -n 1)" 1
  lose unconfigured write "$(own)/bConfigurationValue" 0
  back unconfigured write "$(ls -d /sys/bus/usb/devices/*-1/bConfigurationValue | head -n 1)" 1
  lose killed kill -9 "$simulator"
  back killed device_up --rate 1000 --log
else
  # A gadget that lets go of its pull-up is gone for the host, as when the plug is pulled.
  lose disconnected write /sys/class/udc/dummy_udc.0/soft_connect disconnect
  # dummy_hcd does not come back by "connect": the gadget is made anew.
  kill "$simulator"
  wait "$simulator" 2>/dev/null
  back disconnected device_up --rate 1000 --log
fi
