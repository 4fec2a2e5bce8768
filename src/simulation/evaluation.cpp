#include "pcl_fft_ground/simulation/evaluation.h"

#include <limits>
#include <stdexcept>

namespace pcl_fft_ground::core {
namespace {

double share(std::size_t part, std::size_t whole) {
  if (whole == 0) return std::numeric_limits<double>::quiet_NaN();
  return static_cast<double>(part) / static_cast<double>(whole);
}

}  // namespace

double Confusion::truePositiveRate() const {
  return share(true_positives, true_positives + false_negatives);
}

double Confusion::trueNegativeRate() const {
  return share(true_negatives, true_negatives + false_positives);
}

double Confusion::precision() const {
  return share(true_positives, true_positives + false_positives);
}

double Confusion::intersectionOverUnion() const {
  return share(true_positives, true_positives + false_positives + false_negatives);
}

double Confusion::totalError() const {
  return share(false_positives + false_negatives,
               true_positives + false_positives + true_negatives + false_negatives);
}

double Confusion::kappa() const {
  const auto tp = static_cast<double>(true_positives), fp = static_cast<double>(false_positives);
  const auto tn = static_cast<double>(true_negatives), fn = static_cast<double>(false_negatives);
  const double total = tp + fp + tn + fn;
  const double by_chance = ((tp + fp) * (tp + fn) + (tn + fn) * (tn + fp)) / (total * total);
  return (1 - totalError() - by_chance) / (1 - by_chance);
}

double Confusion::f1() const {
  return share(2 * true_positives, 2 * true_positives + false_positives + false_negatives);
}

Confusion compare(const std::vector<int>& truth, const Labels& labels) {
  if (truth.size() != labels.size()) throw std::invalid_argument("as many labels as true ones are needed");
  Confusion confusion;
  for (std::size_t n = 0; n < truth.size(); ++n) {
    if ((truth[n] != 0 && truth[n] != 1) || labels[n] == Label::NEITHER) continue;
    const bool positive = labels[n] == Label::OBJECT;
    if (truth[n] == 1)
      ++(positive ? confusion.true_positives : confusion.false_negatives);
    else
      ++(positive ? confusion.false_positives : confusion.true_negatives);
  }
  return confusion;
}

}  // namespace pcl_fft_ground::core
