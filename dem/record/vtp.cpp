#include "grainlaw/dem/record/vtp.hpp"

#include <array>
#include <cstdint>
#include <vector>

#include "grainlaw/dem/step/dynamics.hpp"
#include "grainlaw/element/error.hpp"

namespace grainlaw::dem {

namespace {

struct Point {
  Vec3 place{}, velocity{};
  double radius = 0, pressure = 0;
  std::int64_t contacts = 0, grain = -1;  ///< grain -1: no grain, the end of half a contact
};

struct Line {
  std::size_t from, to;
  double overlap, force, share;  ///< share: 1/2 where the contact is two lines
};

struct Network {
  std::vector<Point> points;
  std::vector<Line> lines;
  double mean_force = 0;
};

/// Half the contact, from grain i to the middle of the overlap along `unit`.
void add_half(Network& net, std::size_t i, const Vec3& unit, const Contact& c, double force) {
  Point end;
  for (std::size_t a = 0; a < 3; ++a)
    end.place[a] = net.points[i].place[a] + (net.points[i].radius - 0.5 * c.overlap) * unit[a];
  net.lines.push_back({i, net.points.size(), c.overlap, force, 0.5});
  net.points.push_back(end);
}

void add_contact(Network& net, std::size_t i, std::size_t j, const Contact& c, double force) {
  const Vec3 d{net.points[i].place[0] - net.points[j].place[0],
               net.points[i].place[1] - net.points[j].place[1],
               net.points[i].place[2] - net.points[j].place[2]};
  const Vec3 apart{d[0] - c.branch[0], d[1] - c.branch[1], d[2] - c.branch[2]};
  if (norm(apart) < 1e-6 * c.distance) {  // else an edge of the box, or more
    net.lines.push_back({i, j, c.overlap, force, 1});
    return;
  }
  const Vec3 to_i{c.branch[0] / c.distance, c.branch[1] / c.distance, c.branch[2] / c.distance};
  add_half(net, i, {-to_i[0], -to_i[1], -to_i[2]}, c, force);
  add_half(net, j, to_i, c, force);
}

Network network_of(const State& state, const Material& material) {
  const Dynamics dynamics(material, state);
  const Cell& cell = dynamics.cell();
  Network net;
  net.points.resize(state.count());
  for (std::size_t i = 0; i < state.count(); ++i)
    net.points[i] = {cell.wrap(state.position[i]), state.velocity[i], state.radius[i], 0, 0,
                     static_cast<std::int64_t>(i)};
  const std::vector<std::uint32_t>& id = dynamics.grains().id;
  for_each_contact(dynamics.neighbours().pairs(), dynamics.grains(), cell, [&](const Contact& c) {
    const double force = dynamics.law().force(c.overlap, 0);
    for (const std::size_t i : {id[c.i], id[c.j]}) {
      Point& grain = net.points[i];
      ++grain.contacts;
      grain.pressure += force * (grain.radius - 0.5 * c.overlap) /
                        (3 * sphere_volume(grain.radius) * material.stress_unit());
    }
    net.mean_force += force;
    add_contact(net, id[c.i], id[c.j], c, force);
  });
  double contacts = 0;
  for (const Line& line : net.lines) contacts += line.share;
  if (contacts > 0) net.mean_force /= contacts;
  return net;
}

std::string words(const Vec3& v) { return to_text(v[0]) + " " + to_text(v[1]) + " " + to_text(v[2]); }

/// One DataArray: `value(entry)` as text for each entry of a list.
template <class List, class Value>
std::string array(const std::string& type, const std::string& name, int components, const List& list,
                  Value&& value) {
  std::string text = "<DataArray type=\"" + type + "\" Name=\"" + name + "\" NumberOfComponents=\"" +
                     std::to_string(components) + "\" format=\"ascii\">\n";
  for (const auto& entry : list) text += value(entry) + "\n";
  return text + "</DataArray>\n";
}

/// What holds for the whole packing.
std::string field(const char* name, int components, const std::string& value) {
  return "<DataArray type=\"Float64\" Name=\"" + std::string(name) +
         "\" NumberOfTuples=\"1\" NumberOfComponents=\"" + std::to_string(components) +
         "\" format=\"ascii\">\n" + value + "\n</DataArray>\n";
}

std::string point_data(const std::vector<Point>& points) {
  return "<PointData Scalars=\"pressure\" Vectors=\"velocity\">\n" +
         array("Float64", "radius", 1, points, [](const Point& p) { return to_text(p.radius); }) +
         array("Int64", "contacts", 1, points, [](const Point& p) { return std::to_string(p.contacts); }) +
         array("Float64", "pressure", 1, points, [](const Point& p) { return to_text(p.pressure); }) +
         array("Float64", "velocity", 3, points, [](const Point& p) { return words(p.velocity); }) +
         array("Int64", "grain", 1, points, [](const Point& p) { return std::to_string(p.grain); }) +
         "</PointData>\n";
}

std::string cell_data(const Network& net) {
  const double mean = net.mean_force > 0 ? net.mean_force : 1;
  return "<CellData Scalars=\"force\">\n" +
         array("Float64", "overlap", 1, net.lines, [](const Line& l) { return to_text(l.overlap); }) +
         array("Float64", "force", 1, net.lines, [](const Line& l) { return to_text(l.force); }) +
         array("Float64", "force_over_mean", 1, net.lines,
               [&](const Line& l) { return to_text(l.force / mean); }) +
         array("Float64", "share", 1, net.lines, [](const Line& l) { return to_text(l.share); }) +
         "</CellData>\n";
}

std::string lines_of(const std::vector<Line>& lines) {
  std::size_t end = 0;
  return "<Lines>\n" +
         array("Int64", "connectivity", 1, lines,
               [](const Line& l) { return std::to_string(l.from) + " " + std::to_string(l.to); }) +
         array("Int64", "offsets", 1, lines, [&](const Line&) { return std::to_string(end += 2); }) +
         "</Lines>\n";
}

}  // namespace

std::string vtp_text(const Frame& frame, const Material& material) {
  const Network net = network_of(frame.state, material);
  const Mat3& h = frame.state.box;
  const auto edge = [&h](std::size_t c) { return words({h(0, c), h(1, c), h(2, c)}); };
  return "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" "
         "header_type=\"UInt64\">\n<PolyData>\n<FieldData>\n" +
         field("box", 9, edge(0) + " " + edge(1) + " " + edge(2)) +
         field("nu", 1, to_text(frame.observables.nu)) + field("TimeValue", 1, to_text(frame.state.time_us)) +
         "</FieldData>\n<Piece NumberOfPoints=\"" + std::to_string(net.points.size()) +
         "\" NumberOfVerts=\"0\" NumberOfLines=\"" + std::to_string(net.lines.size()) +
         "\" NumberOfStrips=\"0\" NumberOfPolys=\"0\">\n" + point_data(net.points) + cell_data(net) +
         "<Points>\n" +
         array("Float64", "Points", 3, net.points, [](const Point& p) { return words(p.place); }) +
         "</Points>\n" + lines_of(net.lines) + "</Piece>\n</PolyData>\n</VTKFile>\n";
}

}  // namespace grainlaw::dem
