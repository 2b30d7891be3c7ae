#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

namespace traverse::slam {

/// Ring keys of scans, found by nearness. In their twenty dimensions a k-d tree must look at most
/// of them; here they are the nodes of a graph with links to near ones, and few others to find the
/// way, so that adding and finding take a time that grows with the logarithm of their number.
/// Source: Malkov and Yashunin, "Efficient and robust approximate nearest neighbor search using
/// hierarchical navigable small world graphs", PAMI 2020. A near one can be missed (about one in a
/// hundred). Equal keys, as a simulation without noise makes them, are one node.
///
/// The same answers for the same keys in the same order.
class RingKeyIndex {
 public:
  explicit RingKeyIndex(std::size_t rings);
  RingKeyIndex(const RingKeyIndex& other);
  RingKeyIndex& operator=(const RingKeyIndex& other);
  RingKeyIndex(RingKeyIndex&&) noexcept;
  RingKeyIndex& operator=(RingKeyIndex&&) noexcept;
  ~RingKeyIndex();

  /// The number of the new key is the size before. \throws std::invalid_argument for another number
  /// of rings
  void add(std::span<const float> key);

  std::size_t size() const;

  /// The numbers of up to `most` keys, nearest first; of equally near ones the earlier first.
  std::vector<std::size_t> nearest(std::span<const float> key, std::size_t most) const;

  /// Keys that all searches so far have looked at: what they cost on any machine.
  std::size_t looked_at() const;

 private:
  struct Graph;
  std::size_t rings_;
  std::unique_ptr<Graph> graph_;
};

}  // namespace traverse::slam
