// The figures that Weller (2019) prints in its tables. Parts 2 and 3 follow its text (17 islands
// are part 2); in its tables 5.1 and 5.4 rows 2 and 3 are swapped.

#ifndef TRAVERSE_CLIENT_REPORT_REPRODUCE_THESIS_VALUES_H_
#define TRAVERSE_CLIENT_REPORT_REPRODUCE_THESIS_VALUES_H_

#include <limits>

namespace traverse::report::thesis {

inline constexpr double kNa = std::numeric_limits<double>::quiet_NaN();

// Table 5.2: NO, Guloso, NI2OPT; MILP with SP, NRP, BBCP; BT with NRP 2500, NRP 5000, BBCP 2500,
// BBCP 5000.
inline constexpr int kMethods = 10;
inline constexpr double kContours[3][kMethods] = {
    {1742.29, 995.11, 1090.21, 880.80, 913.26, 913.66, 927.54, 927.51, 928.19, 926.45},
    {6582.47, 2988.23, 3042.15, kNa, 2407.99, 2452.25, 2737.72, 2678.96, 2717.11, 2645.13},
    {3552.68, 1762.69, 1758.65, kNa, 1506.61, 1515.51, 1644.94, 1645.37, 1644.86, 1595.82}};
inline constexpr double kRasters[3][kMethods] = {
    {2048.32, 831.45, 943.66, 795.95, 826.72, 826.72, 873.38, 873.38, 873.38, 873.38},
    {7327.42, 3049.77, 2629.67, kNa, 2553.51, 2534.17, 3161.26, 3073.96, 3135.58, 3066.37},
    {6330.55, 1658.73, 1662.20, kNa, 1570.39, 1552.75, 1813.51, 1794.18, 1809.37, 1781.50}};
inline constexpr double kTotals[3][kMethods] = {
    {3790.62, 1826.57, 2033.87, 1676.75, 1739.99, 1740.39, 1800.92, 1800.89, 1801.58, 1799.83},
    {13909.89, 6038.00, 5671.82, kNa, 4961.50, 4986.41, 5898.98, 5752.92, 5852.69, 5711.50},
    {9883.23, 3421.42, 3420.85, kNa, 3077.00, 3068.27, 3458.46, 3439.55, 3454.22, 3377.32}};

// Table 5.3, in the order NRP 2500, NRP 5000, BBCP 2500, BBCP 5000.
inline constexpr double kDeviations[3][4] = {
    {33.46, 33.45, 33.68, 33.84}, {17.31, 11.16, 19.74, 11.15}, {15.82, 12.02, 14.26, 9.92}};

// Table 5.1: all, island analysis, SP, NRP, BBCP; table 5.4: VP with NRP and BBCP.
inline constexpr double kPoints[3][5] = {
    {477, 309, 262, 15, 4}, {1111, 796, 330, 34, 17}, {1058, 788, 415, 27, 13}};
inline constexpr double kVisible[3][2] = {{64, 64}, {126, 120}, {140, 135}};

// Table 5.5: Guloso, NI2OPT.
inline constexpr double kQuickSeconds[3][2] = {{0.015, 0.013}, {0.46, 1.29}, {0.049, 0.89}};

// Table 5.6: steps 2, 3 and 4 of SP, NRP, BBCP.
inline constexpr double kMilpSeconds[3][9] = {
    {1001.4, 515.6, 0.3, 0.6, 0.8, 0.7, 0.6, 0.7, 0.7},
    {kNa, kNa, kNa, 1504.5, 23.2, 2352.1, 3273.4, 17.3, 2402.5},
    {kNa, kNa, kNa, 112.7, 21.1, 721.6, 131.6, 23.7, 778.5}};

// Tables 5.7 and 5.8: steps 2, 3 and 4 of NRP, BBCP, for 2500 and 5000.
inline constexpr double kTabuSeconds[2][3][6] = {
    {{20, 2, 1, 20, 5, 1}, {60, 10, 36.5, 45, 10.5, 37.5}, {40, 10, 30, 35, 10, 31}},
    {{90, 5, 5, 75, 5, 5}, {210, 25, 80, 130, 25, 80}, {125, 20, 63.5, 110, 20, 64}}};

// Table 3.2: contours 2500, 5000, rasters 2500, 5000: mean, deviation, samples needed.
inline constexpr double kSamples[4][3] = {
    {563.88, 22.89, 3.37}, {546.68, 8.77, 0.53}, {626.61, 15.73, 1.29}, {614.12, 16.36, 1.45}};

// Figure 5.13: hours of 400 layers with NO, Guloso, NI2OPT and the best MILP.
inline constexpr double kHours[3][4] = {
    {4.15, 2.0, 2.22, 1.83}, {15.21, 6.60, 6.20, 5.43}, {kNa, kNa, kNa, kNa}};

}  // namespace traverse::report::thesis

#endif  // TRAVERSE_CLIENT_REPORT_REPRODUCE_THESIS_VALUES_H_
