#!/usr/bin/env bash
# check_layers must accept what the layers allow and name each thing that they do not.
set -euo pipefail
check=$1
tree=$(mktemp -d)
trap 'rm -rf "$tree"' EXIT
mkdir -p "$tree"/{common/core,common/geometry,common/artifact,common/stage,stages/trace,stages/mesh,strake,tests}
touch "$tree"/common/core/types.h "$tree"/common/artifact/artifact.h "$tree"/common/stage/stage.h \
  "$tree"/stages/mesh/mesh.h "$tree"/stages/trace/trace.h "$tree"/stages/trace/stage.h

expect() { # expect accept|refuse FILE LINE
  printf '%s\n' "$3" >"$tree/$2"
  local verdict=accept
  "$check" "$tree" >"$tree/log" 2>&1 || verdict=refuse
  if [ "$verdict" != "$1" ]; then
    echo "expected to $1 in $2: $3" >&2
    cat "$tree/log" >&2
    exit 1
  fi
  if [ "$1" = refuse ] && ! grep -q "$2:1:" "$tree/log"; then
    echo "the refusal does not name $2:1" >&2
    exit 1
  fi
  rm "$tree/$2"
}

expect accept stages/trace/trace.cpp '#include "common/core/types.h"'
expect accept stages/trace/trace.cpp '#include <vector>'
expect accept stages/trace/main.cpp '#include "common/stage/stage.h"'
expect accept common/artifact/hdf5_file.cpp '#include <hdf5.h>'
expect accept tests/x.cpp '#include "stages/mesh/mesh.h"'
expect refuse stages/trace/trace.cpp '#include "stages/mesh/mesh.h"'
expect refuse stages/trace/main.cpp '#include "stages/mesh/mesh.h"'
expect refuse stages/trace/trace.cpp '#include "common/artifact/artifact.h"'
expect refuse stages/trace/trace.cpp '#include "common/stage/stage.h"'
expect refuse stages/trace/trace.cpp '#include "stages/trace/stage.h"'
expect refuse stages/trace/trace.cpp '#include <nlohmann/json.hpp>'
expect refuse stages/trace/trace.cpp '#include <hdf5.h>'
expect refuse stages/trace/trace.cpp '#include "trace.h"'
expect refuse stages/trace/trace.cpp 'void f() { std::cout << 1; }'
expect refuse stages/trace/trace.cpp 'const char* f() { return getenv("X"); }'
expect refuse common/geometry/x.cpp '#include "common/stage/stage.h"'
expect refuse common/geometry/x.cpp 'std::ifstream stream;'
expect refuse common/core/x.cpp '#include <tbb/parallel_for.h>'
expect refuse common/artifact/other.cpp '#include <hdf5.h>'
expect refuse common/artifact/other.cpp '#include "common/stage/stage.h"'
expect refuse common/stage/other.cpp '#include "stages/mesh/mesh.h"'
expect refuse strake/x.cpp '#include <hdf5.h>'
expect accept strake/x.cpp 'auto number = parse_number(text);'
expect refuse strake/x.cpp 'double number = std::stod(text);'
expect refuse common/core/x.cpp 'double number = strtod(text, nullptr);'

printf 'namespace strake {\nstruct Chord {\n};\nclass Known;\n' >"$tree/stages/mesh/mesh.h"
expect accept stages/trace/chord.h 'namespace strake::tracing { struct Chord {}; }'
printf 'namespace strake {\n' >"$tree/stages/trace/trace.h"
expect accept stages/trace/other.h 'class Chord;'
printf 'namespace strake {\nclass Chord : public Known {\n' >"$tree/stages/trace/trace.h"
if "$check" "$tree" >"$tree/log" 2>&1 || ! grep -q 'trace/trace.h:2: strake::Chord is defined in stages/mesh/mesh.h' "$tree/log"; then
  echo "expected to refuse two types of the same name" >&2
  cat "$tree/log" >&2
  exit 1
fi
echo "check_layers keeps the layers"
