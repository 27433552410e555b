#!/usr/bin/env bash
# Installs those packages of apt-packages.txt that are missing. Says nothing where none is.
#   bash cmake/install-dependencies.sh [LIST]   another list of the same form
set -euo pipefail
export LC_ALL=C

list="${1:-$(dirname "${BASH_SOURCE[0]}")/apt-packages.txt}"
if ! command -v apt-get >/dev/null || ! command -v dpkg-query >/dev/null; then
  echo "visp_vlp: no apt on this system; install what $list names, then: cmake --preset release" >&2
  exit 1
fi

mapfile -t wanted < <(sed -e 's/#.*//' -e 's/[[:space:]]//g' -e '/^$/d' "$list" | sort)
installed="$(dpkg-query -W -f='${db:Status-Status} ${Package}\n' "${wanted[@]}" 2>/dev/null | sed -n 's/^installed //p' | sort -u || true)"
mapfile -t missing < <(comm -23 <(printf '%s\n' "${wanted[@]}") - <<<"$installed")
[ "${#missing[@]}" -gt 0 ] || exit 0

echo "visp_vlp: installing ${missing[*]}"
as_root=()
[ "$(id -u)" -eq 0 ] || as_root=(sudo)
"${as_root[@]}" apt-get -q update
"${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -q install -y --no-install-recommends "${missing[@]}"
