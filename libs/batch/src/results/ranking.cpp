#include "results/ranking.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <numeric>
#include <random>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "traverse/batch/metric.hpp"
#include "traverse/files/input_error.hpp"

namespace traverse::batch {

namespace {

constexpr std::size_t kResamples = 20'000;
constexpr std::size_t kFewestRecordings = 5;  // of fewer, resamples are mostly the same
constexpr std::size_t kMostVariants = 60;     // of a grid of thousands nobody asks who differs
constexpr std::size_t kMostAlongDrives = 16;  // variants; pairs of them, each a bootstrap
constexpr double kNormalQuantile97 = 1.959963984540054;  // of 0.975
constexpr double kLevel = 0.05;

/// The mean of a metric over the repeats of each variant on each recording; NaN where none has it.
struct MeansOfRuns {
  std::vector<std::string> recordings;
  std::vector<std::string> variants;
  std::vector<std::vector<double>> values;  ///< [recording][variant]
};

MeansOfRuns means_of_runs(const Results& results, const std::string& metric) {
  MeansOfRuns means;
  std::map<std::string, std::size_t> recordings;
  std::map<std::string, std::size_t> variants;
  const auto index_of = [](std::map<std::string, std::size_t>& known, const std::string& name,
                           std::vector<std::string>& names) {
    const auto [found, is_new] = known.emplace(name, names.size());
    if (is_new) names.push_back(name);
    return found->second;
  };
  std::map<std::pair<std::size_t, std::size_t>, std::pair<double, double>> sums;
  for (const Job& job : results.jobs()) {
    const std::size_t r = index_of(recordings, job.recording, means.recordings);
    const std::size_t v = index_of(variants, job.variant(), means.variants);
    const Completion* completion = results.find(job);
    if (completion == nullptr || !is_usable(completion->outcome)) continue;
    const auto value = value_of(*completion, metric);
    if (!value) continue;
    auto& [sum, count] = sums[{r, v}];
    sum += *value;
    ++count;
  }
  means.values.assign(
      means.recordings.size(),
      std::vector<double>(means.variants.size(), std::numeric_limits<double>::quiet_NaN()));
  for (const auto& [at, sum] : sums) means.values[at.first][at.second] = sum.first / sum.second;
  return means;
}

/// Ranks from 1 on; equal ones share their mean, and so do those without a value, which are last.
std::vector<double> ranks_of(const std::vector<double>& values, bool higher_is_better) {
  std::vector<double> keys;
  for (const double value : values) {
    const bool is_there = value == value;
    keys.push_back(!is_there          ? std::numeric_limits<double>::infinity()
                   : higher_is_better ? -value
                                      : value);
  }
  std::vector<std::size_t> order(keys.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return keys[a] < keys[b]; });
  std::vector<double> ranks(keys.size());
  for (std::size_t first = 0; first < order.size();) {
    std::size_t last = first;
    while (last + 1 < order.size() && keys[order[last + 1]] == keys[order[first]]) ++last;
    const double rank = 1 + static_cast<double>(first + last) / 2;
    for (std::size_t k = first; k <= last; ++k) ranks[order[k]] = rank;
    first = last + 1;
  }
  return ranks;
}

/// Mean ranks of resampled recordings: [variant][resample].
std::vector<std::vector<float>> resampled_means(const std::vector<std::vector<double>>& ranks,
                                                std::size_t variants) {
  std::vector<std::vector<float>> means(variants, std::vector<float>(kResamples));
  std::mt19937_64 random(20'261'130);
  std::vector<double> sums(variants);
  for (std::size_t k = 0; k < kResamples; ++k) {
    std::fill(sums.begin(), sums.end(), 0);
    for (std::size_t i = 0; i < ranks.size(); ++i) {
      const std::vector<double>& drawn = ranks[random() % ranks.size()];
      for (std::size_t v = 0; v < variants; ++v) sums[v] += drawn[v];
    }
    for (std::size_t v = 0; v < variants; ++v) {
      means[v][k] = static_cast<float>(sums[v] / static_cast<double>(ranks.size()));
    }
  }
  return means;
}

std::pair<double, double> interval_of(std::vector<float> values) {
  std::sort(values.begin(), values.end());
  const auto at = [&](double share) {
    return double{values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))]};
  };
  return {at(kLevel / 2), at(1 - kLevel / 2)};
}

/// How likely it is that two means of ranks differ by chance.
double chance_of(const std::vector<float>& a, const std::vector<float>& b) {
  std::size_t not_less = 0;
  std::size_t not_more = 0;
  for (std::size_t k = 0; k < a.size(); ++k) {
    not_less += a[k] >= b[k] ? 1 : 0;
    not_more += a[k] <= b[k] ? 1 : 0;
  }
  const auto rarer = static_cast<double>(std::min(not_less, not_more) + 1);
  return std::min(1.0, 2 * rarer / static_cast<double>(a.size() + 1));
}

/// Two variants, by their place in the ranking, and how likely it is that they differ by chance.
struct RankedPair {
  double chance;
  std::size_t a;
  std::size_t b;
};

/// Which pairs differ at kLevel after Holm's correction for their number.
std::vector<std::vector<bool>> differ_after_holm(std::vector<RankedPair> pairs,
                                                 std::size_t variants) {
  std::stable_sort(pairs.begin(), pairs.end(),
                   [](const RankedPair& x, const RankedPair& y) { return x.chance < y.chance; });
  std::vector<std::vector<bool>> differ(variants, std::vector<bool>(variants, false));
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    if (pairs[k].chance * static_cast<double>(pairs.size() - k) > kLevel) break;
    differ[pairs[k].a][pairs[k].b] = differ[pairs[k].b][pairs[k].a] = true;
  }
  return differ;
}

std::vector<std::vector<bool>> pairs_that_differ(const std::vector<std::vector<float>>& means,
                                                 const std::vector<std::size_t>& order) {
  std::vector<RankedPair> pairs;
  for (std::size_t a = 0; a < order.size(); ++a) {
    for (std::size_t b = a + 1; b < order.size(); ++b) {
      pairs.push_back(RankedPair{chance_of(means[order[a]], means[order[b]]), a, b});
    }
  }
  return differ_after_holm(std::move(pairs), order.size());
}

/// The first run of each recording and variant that has the metric.
using RunsByPlace = std::map<std::pair<std::string, std::string>, const Job*>;

/// The difference of two variants over the drives that both have, and its standard deviation.
struct AlongDrives {
  double mean = 0;
  double sigma = 0;
};

std::optional<AlongDrives> difference_along_drives(const MeansOfRuns& means,
                                                   const RunsByPlace& runs, std::size_t first,
                                                   std::size_t second, RunSeries& series) {
  double sum = 0;
  double variance = 0;
  double count = 0;
  for (std::size_t r = 0; r < means.recordings.size(); ++r) {
    const auto of_first = runs.find({means.recordings[r], means.variants[first]});
    const auto of_second = runs.find({means.recordings[r], means.variants[second]});
    if (of_first == runs.end() || of_second == runs.end()) continue;
    try {
      const auto half = series.half_of_difference(*of_first->second, *of_second->second);
      if (!half) return std::nullopt;
      variance += std::pow(*half / kNormalQuantile97, 2);
    } catch (const files::InputError&) {
      return std::nullopt;  // a run folder that somebody has tidied up
    }
    sum += means.values[r][second] - means.values[r][first];
    ++count;
  }
  if (count == 0) return std::nullopt;
  return AlongDrives{sum / count, std::sqrt(variance) / count};
}

/// Of few recordings: letters and differences to the first, by what varies along the drives.
void tell_along_drives(const Results& results, const MeansOfRuns& means,
                       const std::vector<std::size_t>& order, RunSeries series, Ranking& ranking) {
  RunsByPlace runs;
  for (const Job& job : results.jobs()) {
    const Completion* completion = results.find(job);
    if (completion == nullptr || !is_usable(completion->outcome)) continue;
    if (value_of(*completion, ranking.metric))
      runs.try_emplace({job.recording, job.variant()}, &job);
  }
  std::vector<std::size_t> known;  // variants with the metric, in the order of the ranking
  for (const std::size_t v : order) {
    if (ranking.variants[v].mean) known.push_back(v);
  }
  std::vector<RankedPair> pairs;
  for (std::size_t a = 0; a < known.size(); ++a) {
    for (std::size_t b = a + 1; b < known.size(); ++b) {
      const auto found = difference_along_drives(means, runs, known[a], known[b], series);
      if (!found) continue;
      const double chance = found->sigma > 0
                                ? std::erfc(std::abs(found->mean) / found->sigma / std::sqrt(2.0))
                                : (found->mean == 0 ? 1.0 : 0.0);
      pairs.push_back(RankedPair{chance, a, b});
      if (a > 0) continue;
      const double half = kNormalQuantile97 * found->sigma;
      ranking.variants[known[b]].over_first =
          RankedVariant::Difference{found->mean, found->mean - half, found->mean + half};
    }
  }
  if (pairs.empty()) return;
  const auto letters = compact_letters(differ_after_holm(std::move(pairs), known.size()));
  for (std::size_t k = 0; k < known.size(); ++k) ranking.variants[known[k]].letters = letters[k];
}

bool is_subset(const std::set<std::size_t>& small, const std::set<std::size_t>& large) {
  return std::includes(large.begin(), large.end(), small.begin(), small.end());
}

void mark_front(bool higher_is_better, std::vector<RankedVariant>& variants) {
  const auto better = [&](double a, double b) { return higher_is_better ? a > b : a < b; };
  for (RankedVariant& one : variants) {
    if (!one.mean || !one.wall_s) continue;
    one.is_on_front = std::none_of(variants.begin(), variants.end(), [&](const auto& other) {
      if (!other.mean || !other.wall_s || other.recordings < one.recordings) return false;
      const bool is_as_good = !better(*one.mean, *other.mean) && *other.wall_s <= *one.wall_s;
      return is_as_good && (better(*other.mean, *one.mean) || *other.wall_s < *one.wall_s);
    });
  }
}

/// Mean over the recordings that have a value; how many in `count`.
std::optional<double> mean_over_recordings(const MeansOfRuns& means, std::size_t variant,
                                           std::size_t& count) {
  double sum = 0;
  count = 0;
  for (const auto& values : means.values) {
    if (values[variant] != values[variant]) continue;
    sum += values[variant];
    ++count;
  }
  if (count == 0) return std::nullopt;
  return sum / static_cast<double>(count);
}

}  // namespace

std::vector<std::string> compact_letters(const std::vector<std::vector<bool>>& differ) {
  std::set<std::size_t> all;
  for (std::size_t i = 0; i < differ.size(); ++i) all.insert(i);
  std::vector<std::set<std::size_t>> groups{all};
  for (std::size_t a = 0; a < differ.size(); ++a) {
    for (std::size_t b = a + 1; b < differ.size(); ++b) {
      if (!differ[a][b]) continue;
      std::vector<std::set<std::size_t>> next;
      for (const auto& group : groups) {
        if (!group.contains(a) || !group.contains(b)) {
          next.push_back(group);
          continue;
        }
        for (const std::size_t without : {a, b}) {
          next.push_back(group);
          next.back().erase(without);
        }
      }
      groups.clear();
      for (std::size_t i = 0; i < next.size(); ++i) {
        bool is_absorbed = false;
        for (std::size_t j = 0; j < next.size() && !is_absorbed; ++j) {
          is_absorbed = i != j && is_subset(next[i], next[j]) && (next[i] != next[j] || j < i);
        }
        if (!is_absorbed) groups.push_back(next[i]);
      }
    }
  }
  std::sort(groups.begin(), groups.end());
  std::vector<std::string> letters(differ.size());
  for (std::size_t g = 0; g < groups.size(); ++g) {
    const char letter = static_cast<char>(g < 26 ? 'a' + static_cast<int>(g)
                                                 : 'A' + static_cast<int>((g - 26) % 26));
    for (const std::size_t member : groups[g]) letters[member] += letter;
  }
  return letters;
}

std::optional<Ranking> rank_variants(const Results& results, const std::string& metric,
                                     const RunFolderOf& folder_of) {
  const Metric* known = find_metric(metric);
  if (known == nullptr || (!known->lower_is_better && !known->higher_is_better)) {
    return std::nullopt;
  }
  const MeansOfRuns means = means_of_runs(results, metric);
  if (means.variants.size() < 2) return std::nullopt;
  const MeansOfRuns times = means_of_runs(results, "wall_s");
  const MeansOfRuns frames = means_of_runs(results, "frames_total_ms");
  std::vector<std::vector<double>> ranks;
  for (const auto& values : means.values)
    ranks.push_back(ranks_of(values, known->higher_is_better));

  Ranking ranking{metric, means.recordings.size(), {}};
  for (std::size_t v = 0; v < means.variants.size(); ++v) {
    RankedVariant one;
    one.variant = means.variants[v];
    one.mean = mean_over_recordings(means, v, one.recordings);
    std::size_t timed = 0;
    one.wall_s = mean_over_recordings(times, v, timed);
    one.frames_s = mean_over_recordings(frames, v, timed);
    if (one.frames_s) *one.frames_s /= 1000;
    for (const auto& of_recording : ranks) {
      one.mean_rank += of_recording[v] / static_cast<double>(ranks.size());
    }
    ranking.variants.push_back(std::move(one));
  }
  std::vector<std::size_t> order(ranking.variants.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return ranking.variants[a].mean_rank < ranking.variants[b].mean_rank;
  });
  if (ranks.size() >= kFewestRecordings && means.variants.size() <= kMostVariants) {
    const auto resampled = resampled_means(ranks, means.variants.size());
    const auto letters = compact_letters(pairs_that_differ(resampled, order));
    for (std::size_t k = 0; k < order.size(); ++k) {
      RankedVariant& one = ranking.variants[order[k]];
      one.interval = interval_of(resampled[order[k]]);
      one.letters = letters[k];
    }
  } else if (RunSeries series(metric, folder_of); folder_of && series.is_known() &&
                                                  ranks.size() < kFewestRecordings &&
                                                  means.variants.size() <= kMostAlongDrives) {
    tell_along_drives(results, means, order, std::move(series), ranking);
  }
  mark_front(known->higher_is_better, ranking.variants);
  std::vector<RankedVariant> sorted;
  for (const std::size_t k : order) sorted.push_back(std::move(ranking.variants[k]));
  ranking.variants = std::move(sorted);
  return ranking;
}

page::Table ranking_table(const Ranking& ranking) {
  const Metric& metric = *find_metric(ranking.metric);
  const double none = std::numeric_limits<double>::quiet_NaN();
  const auto any = [&](auto has) {
    return std::any_of(ranking.variants.begin(), ranking.variants.end(), has);
  };
  const bool has_ranks = any([](const auto& one) { return one.interval.has_value(); });
  const bool has_differences = any([](const auto& one) { return one.over_first.has_value(); });
  const bool has_frames = any([](const auto& one) { return one.frames_s.has_value(); });
  std::vector<std::string> heads{"pipeline", "mean rank"};
  if (has_ranks) heads.insert(heads.end(), {"95 % from", "95 % to"});
  heads.insert(heads.end(), {"not told apart", with_unit(metric)});
  if (has_differences) heads.insert(heads.end(), {"more than the first", "95 % from", "95 % to"});
  heads.insert(heads.end(), {"recordings", "wall time [s]"});
  if (has_frames) heads.emplace_back("of its frames alone [s]");
  heads.emplace_back("on the front");
  page::Table table("ranking", "Ranking by " + metric.title, std::move(heads));
  for (const RankedVariant& one : ranking.variants) {
    std::vector<page::Cell> cells{one.variant, page::Cell::fixed(one.mean_rank, 2)};
    if (has_ranks) {
      cells.push_back(one.interval ? page::Cell::fixed(one.interval->first, 2) : page::Cell(none));
      cells.push_back(one.interval ? page::Cell::fixed(one.interval->second, 2) : page::Cell(none));
    }
    cells.emplace_back(one.letters.empty() ? "–" : one.letters);
    cells.emplace_back(one.mean.value_or(none));
    if (has_differences) {
      const auto difference = one.over_first.value_or(RankedVariant::Difference{none, none, none});
      for (const double value : {difference.mean, difference.low, difference.high}) {
        cells.emplace_back(value);
      }
    }
    cells.emplace_back(fmt::format("{} of {}", one.recordings, ranking.recordings));
    cells.emplace_back(one.wall_s.value_or(none));
    if (has_frames) cells.emplace_back(one.frames_s.value_or(none));
    cells.emplace_back(one.is_on_front ? "yes" : "");
    table.add_row(std::move(cells));
  }
  return table;
}

page::Table fairness_table(const Plan& plan, const Results& results) {
  page::Table table(
      "fairness", "What each was told, and what its figures are of",
      {"pipeline", "is", "poses of", "deskew", "poses compared", "time and memory of", "told"});
  for (const PlannedPipeline& pipeline : plan.pipelines) {
    double pairs = 0;
    double frames = 0;
    std::set<std::string> hosts;
    for (const Job& job : results.jobs()) {
      const Completion* completion = results.find(job);
      if (job.pipeline != pipeline.name || completion == nullptr) continue;
      if (!completion->host.empty()) hosts.insert(completion->host);
      const auto matched = value_of(*completion, "pairs");
      const auto used = value_of(*completion, "frames_used");
      if (!matched || !used) continue;
      pairs += *matched;
      frames += *used;
    }
    const PlannedCommand& command = pipeline.command;
    const bool is_command = static_cast<bool>(command);
    std::vector<std::string> told = pipeline.assignments;
    told.insert(told.end(), pipeline.statements.begin(), pipeline.statements.end());
    table.add_row(
        {pipeline.name,
         is_command
             ? "a command" + (command.version.empty() ? "" : ", version " + command.version) +
                   (command.container ? ", in " + command.container.image : "")
             : "the preset " + pipeline.preset,
         is_command ? command.frame + (command.extrinsic.empty() ? "" : ", with an extrinsic")
                    : std::string("body"),
         !is_command      ? std::string("as the preset does it")
         : command.deskew ? std::string("by its own; the map here by its poses")
                          : std::string("by its own; the map here as recorded"),
         frames > 0 ? fmt::format("{:.1f} % of its frames", 100 * pairs / frames)
                    : std::string("–"),
         fmt::format(
             "{}{}", is_command ? "the command alone" : "the run, with its maps and evaluation",
             plan.is_private || hosts.empty() ? std::string()
                                              : fmt::format("; on {}", fmt::join(hosts, ", "))),
         told.empty() ? std::string("nothing more") : fmt::format("{}", fmt::join(told, " "))});
  }
  return table;
}

}  // namespace traverse::batch
