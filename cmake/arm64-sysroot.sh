#!/usr/bin/env bash
# What the preset arm64 builds against: Debian's cross compiler and qemu-user, and in a folder of their own the arm64
# packages of those libraries that apt-packages.txt names. Nothing of them is installed: -dev packages of two
# architectures do not all go together on one machine.
set -euo pipefail
export LC_ALL=C

here="$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)"
if [ "${1:-}" = --help ] || [ "${1:-}" = -h ]; then
  cat <<EOF
usage: arm64-sysroot.sh [DIRECTORY]

Makes DIRECTORY, a root of Debian's libraries for arm64, to cross-build against and to run programs in
(default: build/arm64-sysroot; where it is another, the build needs -DVLP_ARM64_SYSROOT=DIRECTORY).
Installs the cross compiler and qemu-user where they are missing. Downloads 330 MB with the apt sources of this
machine, takes 1.5 GB. Does nothing where DIRECTORY is there already.

example: bash cmake/arm64-sysroot.sh && cmake --preset arm64 && cmake --build --preset arm64 && ctest --preset arm64
EOF
  exit 0
fi
if [ $# -gt 1 ] || [[ "${1:-}" == -* ]]; then
  echo "usage: arm64-sysroot.sh [DIRECTORY] (--help says more)" >&2
  exit 2
fi
out="$(realpath -m "${1:-$here/../build/arm64-sysroot}")"

bash "$here/install-dependencies.sh" "$here/apt-packages-arm64.txt"
if [ -e "$out" ]; then
  if [ ! -e "$out/usr/lib/aarch64-linux-gnu" ]; then
    echo "arm64-sysroot.sh: $out is there and is no arm64 root; name another directory" >&2
    exit 2
  fi
  echo "$out is there already; remove it to have it made anew"
  exit 0
fi

mkdir -p "$(dirname "$out")"
work="$(mktemp -d "$out.XXXXXX")" # beside it, so that the end is one rename
trap 'rm -rf "$work"' EXIT
trap 'exit 143' INT TERM HUP # only after apt has come to its end, which would go on writing
root="$work/root"
libraries="$root/usr/lib/aarch64-linux-gnu"

# An apt of its own: the sources and keys of this machine, another architecture, nothing installed.
mkdir -p "$work"/{state/lists/partial,cache/archives/partial}
: >"$work/status"
cat >"$work/apt.conf" <<EOF
#clear DPkg::Post-Invoke;
#clear DPkg::Pre-Install-Pkgs;
#clear APT::Update::Post-Invoke;
#clear APT::Update::Post-Invoke-Success;
#clear APT::Architectures;
APT::Architecture "arm64";
APT::Architectures { "arm64"; };
APT::Sandbox::User "root";
Dir::State "$work/state";
Dir::State::status "$work/status";
Dir::Cache "$work/cache";
EOF
# The compiler brings the headers of C++; of GCC's own, Debian's ViSP wants what lies at the place of a native compiler.
mapfile -t wanted < <(printf '%s\n' libc6-dev libgcc-12-dev && sed -n 's/^\(lib[^[:space:]]*-dev\)[[:space:]]*$/\1/p' "$here/apt-packages.txt")
echo "== 1 of 3: the packages that ${wanted[*]} need"
apt-get -q -c "$work/apt.conf" update
apt-get -q -c "$work/apt.conf" install -y --no-install-recommends --download-only "${wanted[@]}" |
  awk -v terminal="$([ ! -t 1 ] || echo 1)" '
    /^Get:/ { if (terminal) { printf "\r%d fetched ", ++fetched; fflush() } }
    /^Need to get/ { print; fflush() }
    /^Fetched/ { print (terminal ? "\r" : "") $0 }'

packages=("$work"/cache/archives/*.deb)
echo "== 2 of 3: unpacking ${#packages[@]} packages"
mkdir -p "$root"/usr/{bin,sbin,lib}
for merged in bin sbin lib; do
  ln -s "usr/$merged" "$root/$merged"
done
done_so_far=0
for package in "${packages[@]}"; do
  dpkg-deb --fsys-tarfile "$package" | tar -x -C "$root" --no-same-owner --keep-directory-symlink --exclude='./dev' \
    --exclude='./usr/share/doc' --exclude='./usr/share/man' --exclude='./usr/share/locale' --exclude='./usr/share/icons'
  rm "$package"
  done_so_far=$((done_so_far + 1))
  [ ! -t 1 ] || printf '\r%d of %d' "$done_so_far" "${#packages[@]}"
done
[ ! -t 1 ] || echo

echo "== 3 of 3: links, and the packages of ViSP and Ceres"
# Absolute links would lead out of the root.
while IFS= read -r -d '' link; do
  ln -sfn "$(realpath -ms --relative-to="$(dirname "$link")" "$root$(readlink "$link")")" "$link"
done < <(find "$root" -type l -lname '/*' -print0)
# What the packages' own scripts would have chosen among alternatives.
for name in libblas liblapack; do
  for end in so so.3; do
    ln -s "${name#lib}/$name.$end" "$libraries/$name.$end"
  done
done
# What these need is named by absolute paths.
sed -i '/^ *INTERFACE_/ s|/usr/|${_IMPORT_PREFIX}/|g' "$libraries"/cmake/{visp/VISPModules,Ceres/CeresTargets}.cmake
for name in libvisp_gui.so libvisp_detection.so libvisp_io.so libopencv_aruco.so libopencv_videoio.so; do
  list="$(qemu-aarch64 -L "$root" "$root/lib/ld-linux-aarch64.so.1" --list "$libraries/$name")"
  if grep 'not found' <<<"$list" >&2; then
    echo "arm64-sysroot.sh: $name needs what is named above, which is not in the root" >&2
    exit 1
  fi
done
mv -T "$root" "$out"
echo "made $out"
