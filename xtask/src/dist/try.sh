#!/bin/sh
# An emulated board that has no scene yet gets one and a model by its serial port, is armed, and
# decides what it feels: `decision left smooth` or the like. Needs neither Rust nor a board.
# `./try.sh nucleo-g071rb` takes another board. With a real one, leave the emulated board out and
# set PORT to its port.
set -eu
cd "$(dirname "$0")"
there=$(mktemp -d)
# A board without a scene has its port at 115,200 bits a second; here it stays there.
sed 's/^serial_baud = .*/serial_baud = 115200/' scenes/bench.toml > "$there/bench.toml"
bin/whisker board "$there/bench.toml" --world scenes/textures.toml \
    --program "boards/${1:-nucleo-f446re}.elf" --link "$there/tty" < /dev/null &
board=$!
# It may have ended by itself: then there is nothing to end.
trap 'kill "$board" 2> /dev/null || true; rm -r "$there"' EXIT
# Where it has ended there is no port to come.
until [ -e "$there/tty" ]; do kill -0 "$board"; sleep 0.1; done

PORT="--port $there/tty"
bin/whisker deploy $PORT --scene "$there/bench.toml" --model scenes/models/textures.model
bin/whisker arm $PORT
bin/whisker log $PORT --seconds 4
