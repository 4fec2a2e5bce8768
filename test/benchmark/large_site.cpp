// Makes a binary PCD file of a simulated site, point by point: boulders, piles and terraces
// (test/support/large_site.h).

#include "large_site.h"

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <vector>

namespace {

struct Record {
  float x, y, z;
  std::int32_t label;
};

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) {
    std::cerr << "usage: large_site FILE POINTS [POINTS_A_SQUARE_METRE [SEED]]\n";
    return 2;
  }
  const std::uint64_t count = std::strtoull(argv[2], nullptr, 10);
  const double density = argc > 3 ? std::atof(argv[3]) : 37500;
  const auto seed = static_cast<std::uint32_t>(argc > 4 ? std::atoi(argv[4]) : 1);
  const pcl_fft_ground::test::LargeSite site(std::sqrt(static_cast<double>(count) / density), seed);
  std::ofstream file(argv[1], std::ios::binary);
  file << "VERSION 0.7\nFIELDS x y z label\nSIZE 4 4 4 4\nTYPE F F F I\nCOUNT 1 1 1 1\nWIDTH " << count
       << "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " << count << "\nDATA binary\n";
  std::vector<Record> records;
  for (std::uint64_t n = 0; n < count; ++n) {
    const auto point = site.point(n);
    records.push_back({point.place.x(), point.place.y(), point.place.z(), point.is_object ? 1 : 0});
    if (records.size() < 100000 && n + 1 < count) continue;
    file.write(reinterpret_cast<const char*>(records.data()),
               static_cast<std::streamsize>(records.size() * sizeof(Record)));
    records.clear();
  }
  file.close();
  return file ? 0 : 1;
}
