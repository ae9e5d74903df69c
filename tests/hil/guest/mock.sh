# SPDX-License-Identifier: Apache-2.0
. ./lib.sh
hogs_on
measure at_1k --rate 1000 --seconds 1
measure at_4k --rate 4000 --seconds 1
hogs_off
