// DAMAT, the part format of Weller (2019), figure 3.3: one record a line.
//
//   // INICIO DO ARQUIVO                 `//` starts a comment, also behind a record
//   M,179.468,117.567                    far corner X,Y of the build envelope in mm
//   E,0.25                               thickness of a layer in mm; may be missing
//   nF,393                               number of layers; nF,393,0.25 has the thickness too
//   F1,2                                 layer id, number of islands
//   I1,4,5                               island id, number of contours, number of rasters
//   C1,X96.5621,Y98.1351,X97.0,Y98.2     contour id, its vertices
//   R1,X121.049,Y84.998,X4.02,Y82.9159   raster id, its two ends
//
// Ids are labels: whole numbers, each once in its layer (islands) or island (contours; rasters),
// not necessarily consecutive. The outer contour of an island is the one with the largest area; it
// is read first wherever it stands, and all others have to lie within it. A repeated closing vertex
// of a contour is dropped. With a thickness, layer k is at z = k times that.
//
// In the other spelling, that of the figure itself, a C record holds one vertex, and records of one
// id that follow each other are one contour:
//
//   C1,X96.5621,Y98.1351
//   C1,X97.0,Y98.2
//
// A file has one spelling: contours of several vertices are all on one line, or all on several.
// Blank lines, blanks around commas, CRLF and a byte order mark are accepted. M may be missing; nF
// may not, for without it a file that was cut short looks whole.

#ifndef TRAVERSE_CLIENT_DAMAT_FORMAT_H_
#define TRAVERSE_CLIENT_DAMAT_FORMAT_H_

#include <string_view>

namespace traverse::damat {

inline constexpr std::string_view kComment = "//";
inline constexpr std::string_view kTitle = "// INICIO DO ARQUIVO";
inline constexpr std::string_view kEnvelope = "M";
inline constexpr std::string_view kThickness = "E";
inline constexpr std::string_view kLayerCount = "nF";
inline constexpr char kLayer = 'F';
inline constexpr char kIsland = 'I';
inline constexpr char kContour = 'C';
inline constexpr char kRaster = 'R';

// Coordinates beyond this are refused, as by the service.
inline constexpr double kMaxCoordinateMm = 1e6;

}  // namespace traverse::damat

#endif  // TRAVERSE_CLIENT_DAMAT_FORMAT_H_
