#!/usr/bin/env bash
# bash with-master.sh COMMAND [ARGUMENT...]: runs it with a ROS master of its own, at a free port.
set -euo pipefail

export PATH="/usr/bin:$PATH" # the python3 that Debian's ROS is for
port=$(python3 -c 'import socket; s = socket.socket(); s.bind(("", 0)); print(s.getsockname()[1])')
export ROS_MASTER_URI="http://localhost:$port" ROS_HOSTNAME=localhost ROS_LOG_DIR=$(mktemp -d)
roscore -p "$port" >"$ROS_LOG_DIR/roscore.txt" 2>&1 &
master=$!
trap 'kill $master; wait $master || true; rm -r "$ROS_LOG_DIR"' EXIT
until rostopic list >/dev/null 2>&1; do
  kill -0 "$master" || { cat "$ROS_LOG_DIR/roscore.txt" >&2; exit 1; }
  sleep 0.2
done
"$@"
