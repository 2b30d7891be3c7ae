#include "bags/frame_tree.hpp"

#include <algorithm>
#include <string_view>
#include <utility>

namespace traverse::dataset {

using geometry::Pose3;

namespace {

constexpr double kSame = 1e-6;  // metres, and parts of a rotation matrix
constexpr std::size_t kMostFrames = 10'000;
constexpr std::size_t kDeepest = 100;

bool are_same(const Pose3& a, const Pose3& b) {
  return (a.translation - b.translation).norm() < kSame &&
         (a.rotation - b.rotation).cwiseAbs().maxCoeff() < kSame;
}

}  // namespace

std::string FrameTree::name_of(std::string_view frame) {
  return std::string(frame.starts_with('/') ? frame.substr(1) : frame);
}

bool FrameTree::add_static(const std::string& parent, const std::string& child,
                           const Pose3& T_parent_child) {
  if (links_.size() >= kMostFrames) return false;
  const auto known = links_.find(child);
  const bool is_new = known == links_.end() || !known->second.is_static ||
                      known->second.parent != parent ||
                      !are_same(known->second.T_parent_child, T_parent_child);
  links_[child] = {parent, T_parent_child, true, false};
  return is_new;
}

bool FrameTree::add_moving(const std::string& parent, const std::string& child,
                           const Pose3& T_parent_child) {
  if (links_.size() >= kMostFrames) return false;
  const auto [known, is_new] =
      links_.try_emplace(child, Link{parent, T_parent_child, false, false});
  if (is_new) return true;
  Link& link = known->second;
  if (link.is_static || link.has_moved) return false;
  link.has_moved = link.parent != parent || !are_same(link.T_parent_child, T_parent_child);
  return link.has_moved;
}

bool FrameTree::has(const std::string& frame) const {
  return links_.contains(frame) || std::any_of(links_.begin(), links_.end(), [&](const auto& link) {
           return link.second.parent == frame;
         });
}

std::vector<std::pair<std::string, Pose3>> FrameTree::above(const std::string& frame) const {
  std::vector<std::pair<std::string, Pose3>> chain{{frame, Pose3::identity()}};
  while (chain.size() < kDeepest) {
    const auto link = links_.find(chain.back().first);
    if (link == links_.end() || link->second.has_moved) break;
    chain.emplace_back(link->second.parent, link->second.T_parent_child * chain.back().second);
  }
  return chain;
}

std::optional<Pose3> FrameTree::find(const std::string& target, const std::string& source) const {
  if (target == source) return Pose3::identity();
  const auto of_target = above(target);
  for (const auto& [frame, T_frame_source] : above(source)) {
    for (const auto& [other, T_other_target] : of_target) {
      if (other == frame) return T_other_target.inverse() * T_frame_source;
    }
  }
  return std::nullopt;
}

bool FrameTree::is_by_moving(const std::string& target, const std::string& source) const {
  for (const std::string& frame : {target, source}) {
    for (const auto& [name, pose] : above(frame)) {
      const auto link = links_.find(name);
      if (link != links_.end() && !link->second.is_static) return true;
    }
  }
  return false;
}

}  // namespace traverse::dataset
