// Travel by the kind of move.

#ifndef TRAVERSE_ENGINE_MODEL_TRAVEL_SPLIT_H_
#define TRAVERSE_ENGINE_MODEL_TRAVEL_SPLIT_H_

namespace traverse {

// Lengths in mm, whatever the cost model is. The sum is the route's travel.
struct TravelSplit {
  double contours_mm = 0;  // from the start or a contour to a contour
  double rasters_mm = 0;   // from an open path to an open path
  double links_mm = 0;     // the others
  double total_mm() const { return contours_mm + rasters_mm + links_mm; }

  TravelSplit& operator+=(const TravelSplit& other) {
    contours_mm += other.contours_mm;
    rasters_mm += other.rasters_mm;
    links_mm += other.links_mm;
    return *this;
  }
};

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_MODEL_TRAVEL_SPLIT_H_
