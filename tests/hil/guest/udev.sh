# SPDX-License-Identifier: Apache-2.0
# An ordinary user: without the rule nothing, with it and the limits everything.
. ./lib.sh
/lib/systemd/systemd-udevd --daemon
device_up --rate 1000
udevadm settle
as() { setpriv --reuid 1000 --regid 1000 --groups "$1" env TMPDIR=/tmp "${@:2}"; }

json before as 46 palpate devices --json
bash "$project/tools/setup/host" | sed 's/^/  /'
unplug
sleep 0.3
plug_in
raise_threads
udevadm settle
fact node "$(stat -c '%a %g' /dev/bus/usb/001/* | tail -n 1)"
fact power "$(cat /sys/bus/usb/devices/*-1/power/control | tail -n 1)"
json member as 46 palpate devices --json
json stranger as 1000 palpate devices --json
chmod 1777 /tmp
json without_limits as 46 "${render[@]}" --rate 1000 --seconds 0.4
ulimit -r 95 -l unlimited
json with_limits as 46 "${render[@]}" --rate 1000 --seconds 0.8
json doctor as 46 palpate doctor --json
