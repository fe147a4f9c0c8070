// The sweeps that have a name.

#include "app/measure/sweep.h"

namespace meniscus::measure {

namespace {

constexpr BuiltInSweep kSweeps[] = {
    {"quick", "a protein and packed balls, under a minute", R"({
  "sizes": ["240x180"],
  "scenes": [{"molecule": "1ubq.pdb", "name": "ubiquitin"}],
  "methods": "all",
  "steps": 4,
  "scaling": [100, 1000, 4000],
  "repetitions": 3,
  "budget": 25,
  "leavingOut": "1ubq.pdb"
})"},
    {"surface", "three proteins, two views, up to 100,000 balls", R"({
  "sizes": ["640x480"],
  "scenes": [
    {"molecule": "1ubq.pdb", "name": "ubiquitin"},
    {"molecule": "2hhb.pdb.gz", "name": "hemoglobin"},
    {"molecule": "7ddo.pdb.gz", "name": "ACE2"}
  ],
  "views": [{"name": "front"}, {"name": "close", "rotate": [0, 90, 0], "zoom": 4}],
  "methods": "all",
  "steps": 6,
  "scaling": [100, 1000, 10000, 100000],
  "repetitions": 5,
  "leavingOut": "2hhb.pdb.gz"
})"},
    {"shadows", "samples of soft shadows", R"({
  "repetitions": 5,
  "sizes": ["1024x768"],
  "shadows": [
    {"molecule": "1ubq.pdb", "name": "ubiquitin, space-filling"},
    {"molecule": "2hhb.pdb.gz", "name": "hemoglobin, space-filling"},
    {"molecule": "2hhb.pdb.gz", "name": "hemoglobin, space-filling, narrow", "penumbra": 0.5},
    {"molecule": "2hhb.pdb.gz", "name": "hemoglobin, licorice", "representation": "licorice"},
    {"molecule": "7ddo.pdb.gz", "name": "ACE2 x 8, space-filling", "copies": [2, 2, 2]}
  ]
})"},
    {"stability", "stiff and extreme scenes, every method", R"({
  "stability": {"size": "96x72", "timeLimit": 120}
})"},
    {"papers", "the papers' tables beside the same, here", R"({
  "repetitions": 3,
  "papers": {"scale": 0.5, "mostBalls": 100000}
})"},
};

}  // namespace

std::span<const BuiltInSweep> builtInSweeps() {
  return kSweeps;
}

}  // namespace meniscus::measure
