#!/usr/bin/env bash
# hnswlib: a thousand equal keys (a vehicle that stands still describes one place again and again) hide nearly every
# other key from the search, which then answers with far points, without an error. Needs g++.
source "$(dirname "$0")/install.sh"
debian libhnswlib-dev=0.6.2-2+deb12u1
cxx -O2 <<'CXX'
#include <hnswlib/hnswlib.h>
#include <cstdio>
#include <random>
int lost(int standing) { // of 500 keys in the index, how many a search for that very key does not find
  constexpr int kLength = 20;
  hnswlib::L2Space space(kLength);
  hnswlib::HierarchicalNSW<float> index(&space, 2000, 16, 200);
  index.setEf(50);
  std::mt19937 random(1);
  std::vector<std::vector<float>> keys(500, std::vector<float>(kLength));
  for (auto& key : keys)
    for (float& value : key) value = random() / 4294967296.0f;
  const std::vector<float> still(kLength, 0.5f);
  hnswlib::labeltype label = 0;
  for (int i = 0; i < 250; ++i) index.addPoint(keys[i].data(), label++);
  for (int i = 0; i < standing; ++i) index.addPoint(still.data(), label++);
  for (int i = 250; i < 500; ++i) index.addPoint(keys[i].data(), label++);
  int count = 0;
  for (const auto& key : keys) {
    const auto nearest = index.searchKnn(key.data(), 1);
    count += nearest.empty() || nearest.top().first > 1e-6f;
  }
  return count;
}
int main() { std::printf("%d of 500 keys lost; after 1000 equal ones %d of 500", lost(0), lost(1000)); }
CXX
report "hnswlib 0.6.2 (M 16, efConstruction 200, ef 50)" "0 of 500 keys lost; after 1000 equal ones few of 500" \
  "$("$tmp/probe")" "[0-2] of 500 keys lost; after 1000 equal ones (3[5-9].|4..) of 500"
