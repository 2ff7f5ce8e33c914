// Paths as arrays of [x, y] become what the API takes, with their positions from 0 as ids.
const paths = (given) => given.map((points, id) => ({ id, points: points.flat() }));

export const island = ({ id = 0, contours = [], rasters = [] }) => ({
  id, contours: paths(contours), rasters: paths(rasters) });

export const layer = (islands, { id = 0, zMm = 0, initialRoute = [] } = {}) => ({
  id, z_mm: zMm, islands, initial_route: initialRoute });
