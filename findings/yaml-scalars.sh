#!/usr/bin/env bash
# One parameter file, two readers of Debian (yaml-cpp for C++, PyYAML for Python): a noise 1e-3 is a number for one and
# text for the other, a latitude in degrees, minutes and seconds becomes 173244, and yaml-cpp has two values for 010.
# Needs g++ and python3.
source "$(dirname "$0")/install.sh"
debian libyaml-cpp-dev=0.7.0+dfsg-8+b1 libyaml-cpp0.7=0.7.0+dfsg-8+b1
debian_with_dependencies python3-yaml=6.0-3+b2
echo '{noise: 1e-3, latitude: 48:07:24.44, zone: 010}' >"$tmp/p.yaml"
cxx -lyaml-cpp <<'CXX'
#include <iostream>
#include <yaml-cpp/yaml.h>
int main(int, char** argument) {
  const YAML::Node p = YAML::LoadFile(argument[1]);
  std::cout << "yaml-cpp: " << p["noise"].as<double>() << ", " << p["latitude"].as<std::string>() << ", "
            << p["zone"].as<int>() << " or " << p["zone"].as<double>();
}
CXX
seen="$("$tmp/probe" "$tmp/p.yaml"); $(python3 - "$tmp/p.yaml" <<'PY'
import sys, yaml
p = yaml.safe_load(open(sys.argv[1]))
print("PyYAML: %r, %r, %r" % (p["noise"], p["latitude"], p["zone"]))
PY
)"
report "yaml-cpp 0.7.0, PyYAML 6.0" "the number 0.001, the text 48:07:24.44 and the number 10 from both" "$seen" \
  "yaml-cpp: 0.001, 48:07:24.44, 8 or 10; PyYAML: '1e-3', 173244.44, 8"
