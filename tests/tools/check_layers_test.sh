#!/bin/sh
# Planted faults that tools/check_layers must find, in a small house of its own.
set -eu
root=$1
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
. "$root/tests/tools/expect.sh"

# A house without faults: base below math below render, and a program on top.
build_house() {
    rm -rf "$work/src"
    mkdir -p "$work/src/base" "$work/src/math" "$work/src/formats" "$work/src/render" "$work/src/cli"
    cat >"$work/src/CMakeLists.txt" <<'END'
# alhazen_room(commented SEES nothing)
alhazen_room(base LIBRARIES Threads::Threads PRIVATE fmt::fmt)
alhazen_room(math SEES base)
alhazen_room(formats SEES math
             PRIVATE fmt::fmt)
alhazen_room(render SEES formats)
END
    echo '#pragma once' >"$work/src/base/vec.h"
    echo '#include "base/vec.h"' >"$work/src/math/warp.h"
    echo '#include "math/warp.h"' >"$work/src/formats/format.h"
    printf '#include <vector>\n#include "base/vec.h"\n#include "formats/format.h"\n' >"$work/src/render/render.h"
    echo '#include "render/render.h"' >"$work/src/cli/main.cpp"
}
check() { "$root/tools/check_layers" "$work"; }

build_house
succeeds_with 'Layers: 4 rooms' check

build_house
printf '\n#include "math/warp.h"\n' >>"$work/src/base/vec.h"
fails_with 'src/base/vec.h:3: room base includes from math, which it does not see' check

build_house
echo '#include "vec.h"' >>"$work/src/base/vec.h"
fails_with 'src/base/vec.h:2: there is no src/vec.h' check

build_house
echo '#  include "cli/main.cpp"' >"$work/src/render/render.h"
fails_with 'render.h:1: room render includes from cli, which is no room' check

build_house
echo 'alhazen_room(film SEES camera)' >>"$work/src/CMakeLists.txt"
fails_with 'CMakeLists.txt:7: room film sees camera, which is no room' check

build_house
sed -i 's/^alhazen_room(base /&SEES render /' "$work/src/CMakeLists.txt"
fails_with 'rooms see each other: base -> render -> formats -> math -> base' check

build_house
sed -i 's/^alhazen_room(render .*//; s/formats SEES math/formats SEES render/' "$work/src/CMakeLists.txt"
echo 'alhazen_room(render SEES math)' >>"$work/src/CMakeLists.txt"
fails_with 'room formats must not see render' check

build_house
mkdir "$work/src/attic"
echo >"$work/src/attic/box.h"
fails_with 'src/attic: no alhazen_room\(attic\)' check

finish
