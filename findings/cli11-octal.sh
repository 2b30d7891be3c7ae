#!/usr/bin/env bash
# CLI11 reads a zero-padded whole number as octal, and the same word as decimal when the option is floating point.
# Needs g++.
source "$(dirname "$0")/install.sh"
debian libcli11-dev=2.1.2+ds-1
cxx <<'CXX'
#include <CLI/CLI.hpp>
#include <iostream>
template <class T> std::string read(const std::string& word) {
  CLI::App app;
  T value{};
  app.add_option("--frame", value);
  try {
    app.parse("--frame " + word);
  } catch (const CLI::Error&) {
    return "refused";
  }
  std::ostringstream text;
  text << value;
  return text.str();
}
int main() {
  std::cout << "000100 is " << read<int>("000100") << " as int and " << read<double>("000100")
            << " as double; 000108 is " << read<int>("000108");
}
CXX
report "CLI11 2.1.2" "000100 is 100 as int and 100 as double; 000108 is 108" "$("$tmp/probe")" \
  "000100 is 64 as int and 100 as double; 000108 is refused"
