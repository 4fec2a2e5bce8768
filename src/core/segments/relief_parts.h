#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include <Eigen/Core>

#include "segments/relief.h"

namespace pcl_fft_ground::core {

/// How a set of columns is spread in the plane [columns].
struct Spread {
  double count = 0, x = 0, y = 0, xx = 0, xy = 0, yy = 0;  ///< sums of whole numbers, in any order
  double z = 0, xz = 0, yz = 0;                            ///< the same of heights

  void add(double at_x, double at_y, double height);
  void add(const Spread& other);
  Eigen::Vector2d mean() const { return {x / count, y / count}; }
  double height() const { return z / count; }
  /// Variance along a direction of unit length; a column is a square, not a point.
  double varianceAlong(const Eigen::Vector2d& direction) const;
  /// Rise of the heights per column along a direction of unit length.
  double slopeAlong(const Eigen::Vector2d& direction) const;
};

/// Standard deviations [columns] along the axis of a spread and across it.
struct SpreadAxes {
  double length = 0, width = 0;
  Eigen::Vector2d axis = Eigen::Vector2d::UnitX();
};
SpreadAxes axesOf(const Spread& spread);

/// A connected piece of a relief, perhaps an object.
struct Part {
  Spread spread;
  SpreadAxes axes;
  std::vector<Eigen::Vector2d> hull;  ///< around its columns, counter-clockwise
  double hollow = 0;                  ///< area of the hull that the part does not fill [columns]
  std::int32_t cluster = 0;           ///< the contact cluster that it belongs to
};

/// Where a part meets another one; sums over pairs of touching columns.
struct Border {
  std::int32_t other = 0;
  double length = 0;  ///< [columns]
  double crease = 0;  ///< concavity times length
  double open = 0;    ///< length without a crease to speak of

  void add(const Border& more);
};

/// The parts of a relief, and which touch. Joining changes both.
class PartGraph {
 public:
  /// \param part number of its part, per column \param concave how concave each column is
  PartGraph(const Relief& relief, std::vector<std::int32_t> part, const std::vector<float>& concave);

  std::size_t size() const { return parts_.size(); }  ///< with those that others have taken in
  bool exists(std::int32_t part) const { return owner_[static_cast<std::size_t>(part)] == part; }
  const Part& part(std::int32_t number) const { return parts_[static_cast<std::size_t>(number)]; }
  const std::vector<Border>& borders(std::int32_t part) const {
    return borders_[static_cast<std::size_t>(part)];
  }
  /// The part that a column belongs to by now.
  std::int32_t partAt(std::size_t column);

  /// Joins two parts, whether they touch or not. \return the number that both go by from now on
  std::int32_t join(std::int32_t a, std::int32_t b);

  /** Joins touching parts, the cheapest first, until none costs less than the limit.
   * \param cost of joining two parts, \c smaller the one with fewer columns
   */
  using Cost = std::function<double(const Part& larger, const Part& smaller, const Border& border)>;
  void joinUpTo(double limit, const Cost& cost);

  /// Gives the parts their hulls; from then on joined ones get theirs, too.
  void outline(const Relief& relief);

 private:
  std::int32_t find(std::int32_t part);
  double costOf(std::int32_t a, const Border& border, const Cost& cost) const;

  std::vector<std::int32_t> part_of_column_;
  std::vector<Part> parts_;
  std::vector<std::vector<Border>> borders_;  // per part, by rising number of the other
  std::vector<std::int32_t> owner_;
  std::vector<std::uint32_t> version_;  // rises when a part takes another in
  bool outlined_ = false;
};

/// Area within the hull of two parts that neither fills nor one of their own hulls holds [columns].
double hollowBetween(const Part& a, const Part& b);

}  // namespace pcl_fft_ground::core
