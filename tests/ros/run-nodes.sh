#!/usr/bin/env bash
# bash run-nodes.sh <build of apps/ros> [ARGUMENT...]: test_nodes of that build, with a master of its own.
set -euo pipefail

export PATH="/usr/bin:$PATH" # the python3 that Debian's ROS is for
port=$(python3 -c 'import socket; s = socket.socket(); s.bind(("", 0)); print(s.getsockname()[1])')
export ROS_MASTER_URI="http://localhost:$port" ROS_HOSTNAME=localhost ROS_LOG_DIR=$(mktemp -d)
roscore -p "$port" >"$ROS_LOG_DIR/roscore.txt" 2>&1 &
master=$!
trap 'kill $master; wait $master || true; rm -r "$ROS_LOG_DIR"' EXIT
build=$1
shift
"$build/devel/lib/visp_vlp/test_nodes" "$@"
