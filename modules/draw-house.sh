#!/usr/bin/env bash
# Draws which module stands on which, out of the lines vp_add_module(...) of their CMakeLists.txt.
#   bash modules/draw-house.sh            writes modules/img-house.svg
#   bash modules/draw-house.sh --check    fails where that picture is of other lines, or where a module includes a
#                                         header of a module on which it does not stand
# A module's floor is one above the highest module on which it stands. An arrow that others imply is left out.
set -euo pipefail
export LC_ALL=C
cd "$(dirname "${BASH_SOURCE[0]}")"

lines() # MODULE and the modules on which it stands, each without vlp_
{
  local file
  for file in vlp_*/CMakeLists.txt; do
    tr '\n' ' ' <"$file" | grep -o 'vp_add_module([^)]*)' | sed -e 's/vp_add_module(vlp_//' -e 's/)//' |
      awk '{ printf "%s", $1; for (i = 2; i <= NF; ++i) if (sub(/^visp_vlp_/, "", $i)) printf " %s", $i; print "" }'
  done
}

draw()
{
  lines | awk '
    BEGIN { # columns, and what is written below the name
      put("core", 1.5, "files, lamps, rig, frames"); put("sensor", 0, "cameras, videos, pictures")
      put("robot", 1, "TurtleBot3 and its board"); put("detection", 2, "where a lamp is")
      put("evaluation", 3, "errors, figures"); put("simulation", 0.35, "pictures with truth")
      put("identification", 2, "which lamp it is"); put("tracking", 2, "from frame to frame")
      put("localization", 1.85, "pose and covariance"); put("servo", 0.35, "keeps to a path")
      put("calibration", 2.6, "of rig and lamps")
    }
    function put(name, column, text) { x[name] = 110 + 190 * column; says[name] = text }
    function floorOf(m,   i, best) {
      if (m in level) return level[m]
      if (m in open) fail("a circle through vlp_" m)
      open[m] = 1; best = 0
      for (i = 1; i <= count[m]; ++i) if (floorOf(on[m, i]) > best) best = level[on[m, i]]
      return level[m] = best + 1
    }
    function reaches(from, to,   i) { # from stands on to, in one step or more
      for (i = 1; i <= count[from]; ++i) if (on[from, i] == to || reaches(on[from, i], to)) return 1
      return 0
    }
    function fail(text) { print "draw-house.sh: " text > "/dev/stderr"; failed = 1; exit 1 }
    { if (!($1 in x)) fail("vlp_" $1 ": no place in the drawing, give it one in BEGIN")
      module[++n] = $1; count[$1] = NF - 1; for (i = 2; i <= NF; ++i) on[$1, i - 1] = $i }
    END {
      if (failed) exit 1
      for (k = 1; k <= n; ++k) if (floorOf(module[k]) > top) top = level[module[k]]
      height = 78 * top + 30
      printf "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 800 %d\" font-family=\"sans-serif\">\n", height
      print "<defs><marker id=\"tip\" viewBox=\"0 0 8 8\" refX=\"8\" refY=\"4\" markerWidth=\"7\" markerHeight=\"7\" orient=\"auto\"><path d=\"M0 0L8 4L0 8z\" fill=\"#555\"/></marker></defs>"
      printf "<rect width=\"800\" height=\"%d\" fill=\"white\"/>\n", height
      print "<text x=\"400\" y=\"24\" font-size=\"15\" text-anchor=\"middle\">apps, tutorial and tests stand on all modules</text>"
      for (k = 1; k <= n; ++k) y[module[k]] = 46 + 78 * (top - level[module[k]])
      for (f = 1; f <= top; ++f) printf "<text x=\"8\" y=\"%d\" font-size=\"13\" fill=\"#888\">%d</text>\n", 72 + 78 * (top - f), f
      for (k = 1; k <= n; ++k) for (i = 1; i <= count[m = module[k]]; ++i) {
        to = on[m, i]; implied = 0
        for (j = 1; j <= count[m]; ++j) if (reaches(on[m, j], to)) implied = 1
        if (implied) continue
        shift = (x[to] - x[m]) / 2; if (shift > 78) shift = 78; if (shift < -78) shift = -78
        back = -shift; if (to == "core") { shift = 0; back = x[m] - x[to] }
        printf "<line x1=\"%d\" y1=\"%d\" x2=\"%d\" y2=\"%d\" stroke=\"#555\" marker-end=\"url(#tip)\"/>\n", x[m] + shift, y[m] + 46, x[to] + back, y[to] - 1
      }
      for (k = 1; k <= n; ++k) {
        m = module[k]; wide = m == "core" ? 740 : 176
        printf "<rect x=\"%d\" y=\"%d\" width=\"%d\" height=\"46\" rx=\"5\" fill=\"#e8eef7\" stroke=\"#4a6da7\"/>\n", x[m] - wide / 2, y[m], wide
        printf "<text x=\"%d\" y=\"%d\" font-size=\"15\" text-anchor=\"middle\">vlp_%s</text>\n", x[m], y[m] + 20, m
        printf "<text x=\"%d\" y=\"%d\" font-size=\"12\" fill=\"#444\" text-anchor=\"middle\">%s</text>\n", x[m], y[m] + 37, says[m]
      }
      print "</svg>"
    }'
}

if [ "${1:-}" != --check ]; then
  picture=$(draw)
  printf '%s\n' "$picture" >img-house.svg
  exit 0
fi

status=0
diff -q <(draw) img-house.svg >/dev/null || { echo "modules/img-house.svg is of other lines: bash modules/draw-house.sh"; status=1; }
while read -r module others; do
  while read -r used; do
    case " $module $others " in *" $used "*) ;; *) echo "vlp_$module includes vlp_$used, on which it does not stand"; status=1 ;; esac
  done < <(grep -rhoE '#include [<"]visp3/vlp_[a-z]+/' "vlp_$module" | sed -E 's|.*vlp_([a-z]+)/|\1|' | sort -u)
done < <(lines)
[ "$status" -eq 0 ] && echo "every module includes only what it stands on; the drawing is up to date"
exit "$status"
