#include "apps/hapticgiant/experiments/experiment_measures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace hg::apps {
namespace {

constexpr double kPathReached_m = 0.05;  // a checkpoint counts
constexpr double kDegrees = 180.0 / std::numbers::pi;

/// Statistics of a signal over a time interval. All are NaN for an empty interval: an event is
/// missing.
struct Stretch {
  double mean = std::numeric_limits<double>::quiet_NaN(), least = mean, most = mean;
  double magnitude() const { return std::max(std::abs(least), std::abs(most)); }
};

/// Evaluates the table of a run.
class Look {
 public:
  explicit Look(const ExperimentResult& result) : result_(result), table_(*result.table) {}

  double t(std::string_view event) const { return result_.time_of(event); }
  double end() const { return table_["time_s"].back(); }
  Stretch over(std::string_view signal, double from_s, double to_s) const {
    Stretch stretch;
    if (!(from_s < to_s)) return stretch;
    const RowRange rows = table_.between(from_s, to_s);
    if (rows.begin >= rows.end) return stretch;
    const std::vector<double>& values = table_[signal];
    const auto begin = values.begin() + static_cast<std::ptrdiff_t>(rows.begin);
    const auto end = values.begin() + static_cast<std::ptrdiff_t>(rows.end);
    double sum = 0.0;
    for (auto value = begin; value != end; ++value) sum += *value;
    const auto [least, most] = std::minmax_element(begin, end);
    return {sum / static_cast<double>(rows.end - rows.begin), *least, *most};
  }
  double at(std::string_view signal, double time_s) const {
    const RowRange rows = table_.between(0.0, time_s);
    if (std::isnan(time_s) || rows.end >= table_.rows()) return Stretch{}.mean;
    return table_[signal][rows.end];
  }
  const RunTable& table() const { return table_; }

 private:
  const ExperimentResult& result_;
  const RunTable& table_;
};

// a value, or "-" where an event is missing
std::string number(double value, int digits) {
  return std::isnan(value) ? "-" : fmt::format("{:.{}f}", value + 0.0, digits);
}

/// Mean force while a limit is felt, and while none is; share of the time with one.
struct LimitForces {
  double free_mean = 0.0, felt_mean = 0.0, felt_most = 0.0, felt_share = 0.0;
};

LimitForces limit_forces(const RunTable& table) {
  LimitForces forces;
  const auto& force = table["force_N"];
  const auto& felt = table["felt_limit"];
  const auto& running = table["running"];
  double count[2] = {0.0, 0.0}, sum[2] = {0.0, 0.0};
  for (std::size_t row = 0; row < table.rows(); ++row) {
    if (running[row] == 0.0) continue;
    const bool is_felt = felt[row] >= 0.0;
    count[is_felt] += 1.0;
    sum[is_felt] += force[row];
    if (is_felt) forces.felt_most = std::max(forces.felt_most, force[row]);
  }
  forces.free_mean = count[0] > 0.0 ? sum[0] / count[0] : 0.0;
  forces.felt_mean = count[1] > 0.0 ? sum[1] / count[1] : 0.0;
  forces.felt_share = count[1] / std::max(count[0] + count[1], 1.0);
  return forces;
}

std::vector<Statement> measure_cartesian(const Look& look) {
  const double a = look.t("t_a"), b = look.t("t_b"), b2 = look.t("t_b'"), c = look.t("t_c"),
               d = look.t("t_d"), e = look.t("t_e"), f = look.t("t_f"), g = look.t("t_g");
  const LimitForces forces = limit_forces(look.table());
  const auto force = [&](double from_s, double to_s) { return look.over("force_N", from_s, to_s); };
  return {
      {"t_a: turn of joint 1", "a full turn is completed",
       fmt::format("at {} s; force until then at most {} N", number(a, 2),
                   number(force(1.0, a).most, 1))},
      {"t_b: elbow at its limit in x", "its motion is inhibited, the hand moves on, force rises",
       fmt::format(
           "elbow at most at {} m (limit 1.65), hand moves on by {} m in 1 s, force {} to {} "
           "N",
           number(look.over("elbow_x_m", 0.0, look.end()).most, 4),
           number(look.at("hand_x_m", b + 1.0) - look.at("hand_x_m", b), 2),
           number(force(b - 0.5, b).mean, 1), number(force(b, b + 1.0).most, 1))},
      {"t_b': hand at its limit in x", "a peak of the resistance",
       fmt::format("peak {} N", number(force(b2, b2 + 2.0).most, 1))},
      {"t_c: singularity", "the measure does not exceed its limit, torque increases",
       fmt::format("q4+q5 at least {} rad (limit 0.26), torque {} to {} Nm",
                   number(look.over("q4+q5_rad", 0.0, look.end()).least, 4),
                   number(look.over("torque_Nm", c - 0.5, c).mean, 2),
                   number(look.over("torque_Nm", c, c + 1.0).most, 2))},
      {"t_d: joint 6 at its lower limit", "maintained without affecting other parts",
       fmt::format(
           "m6 at least {} rad (limit -2.6); fastest other joint in the next 0.5 s: {} rad/s",
           number(look.over("m6_rad", 0.0, look.end()).least, 4),
           number(std::max({look.over("m1_rad_per_s", d, d + 0.5).magnitude(),
                            look.over("m2_rad_per_s", d, d + 0.5).magnitude(),
                            look.over("m3_rad_per_s", d, d + 0.5).magnitude(),
                            look.over("m4_rad_per_s", d, d + 0.5).magnitude()}),
                  3))},
      {"t_e: joint 4 at its upper limit", "height cannot be increased, force jumps",
       fmt::format("m4 at most {} rad (limit 2.45), force {} to {} N; height {} m, then {} m by "
                   "tilting the handle",
                   number(look.over("m4_rad", 0.0, look.end()).most, 4),
                   number(force(e - 0.5, e).mean, 1), number(force(e, e + 1.0).most, 1),
                   number(look.at("hand_z_m", e), 3),
                   number(look.over("hand_z_m", e, e + 1.5).most, 3))},
      {"t_f: gantry ends in y", "full stop in y, x still possible, force and torque stay low",
       fmt::format(
           "until t_g: force at most {} N, torque at most {} Nm; joint 2 goes from {} to {} "
           "rad",
           number(force(f, g).most, 1), number(look.over("torque_Nm", f, g).most, 2),
           number(look.at("m2_rad", f), 2), number(look.at("m2_rad", g), 2))},
      {"t_g: joint 2 at its upper limit", "force increases; then joint 1 rotates rapidly",
       fmt::format("force {} to {} N; joint 1 up to {} rad/s", number(force(g - 0.5, g).mean, 1),
                   number(force(g, g + 2.0).most, 1),
                   number(look.over("m1_rad_per_s", g, look.end()).magnitude(), 2))},
      {"mean force free / while a limit is felt", "",
       fmt::format("{:.1f} / {:.1f} N", forces.free_mean, forces.felt_mean)},
  };
}

std::vector<Statement> measure_excavator(const Look& look) {
  const double a = look.t("t_a"), b = look.t("t_b"), c = look.t("t_c"), d = look.t("t_d"),
               e = look.t("t_e");
  const auto others = [&](double from_s, double to_s) {
    double fastest = 0.0;
    for (const char* name : {"boom_rad_per_s", "stick_rad_per_s", "bucket_rad_per_s"}) {
      fastest = std::max(fastest, look.over(name, from_s, to_s).magnitude());
    }
    return fastest;
  };
  return {
      {"t_a: bucket at its upper limit, boom at its lower one",
       "a sudden increase in the velocity of the stick",
       fmt::format("stick {} rad/s before, {} rad/s within 0.3 s; boom at {} rad",
                   number(look.at("stick_rad_per_s", a - 0.05), 2),
                   number(look.over("stick_rad_per_s", a, a + 0.3).most, 2),
                   number(look.at("boom_rad", a), 4))},
      {"t_b: arm fully extended", "the stick is at its lower limit",
       fmt::format("stick at least {} rad (limit 0)",
                   number(look.over("stick_rad", b, b + 1.0).least, 5))},
      {"t_c: swing at its lower limit", "other joints move freely",
       fmt::format("swing at least {} rad (limit -0.9); other joints up to {} rad/s",
                   number(look.over("swing_rad", c, d).least, 5), number(others(c, c + 1.0), 2))},
      {"t_d: swing at its upper limit", "other joints move freely",
       fmt::format("swing at most {} rad (limit 0.9); other joints up to {} rad/s",
                   number(look.over("swing_rad", d, d + 2.0).most, 5),
                   number(others(d, d + 1.0), 2))},
      {"t_e: digging and unloading", "a typical motion of the bucket",
       fmt::format("bucket from {} to {} rad, boom up to {} rad",
                   number(look.over("bucket_rad", e, look.end()).most, 2),
                   number(look.over("bucket_rad", e, look.end()).least, 2),
                   number(look.over("boom_rad", e, look.end()).most, 2))},
      {"largest force of the hand", "",
       number(look.over("force_N", 0.0, look.end()).most, 1) + " N"},
  };
}

std::string phases_text(const std::vector<LockedPhase>& phases) {
  std::string text;
  for (const LockedPhase& phase : phases) {
    text += fmt::format("{}{:.2f} .. {:.2f} s", text.empty() ? "" : ", ", phase.from_s, phase.to_s);
  }
  return text.empty() ? "never" : text;
}

std::vector<Statement> measure_door(const Look& look) {
  const double a = look.t("locked"), b = look.t("handle pressed"), c = look.t("unlocked"),
               d = look.t("open stop"), e = look.t("velocity limit");
  const auto at_lock = look.over("hinge_rad", a, b);
  const auto pulled = look.over("hinge_rad", b, look.t("locked again"));
  return {
      {"t_a: pushed and pulled, not pressed", "no movement",
       fmt::format("hinge moves by {} mrad under up to {} N", number(1e3 * at_lock.magnitude(), 3),
                   number(look.over("force_N", a, b).most, 1))},
      {"t_b: pressed, but pulled", "the door does not open",
       fmt::format("hinge moves by {} mrad under up to {} N", number(1e3 * pulled.magnitude(), 3),
                   number(look.over("force_N", b, look.t("locked again")).most, 1))},
      {"t_c: leaned against, pressed", "the door pops open",
       fmt::format("force {} N before, hinge at {} rad/s 0.3 s later",
                   number(look.at("force_N", c - 0.1), 1),
                   number(look.at("hinge_rad_per_s", c + 0.3), 2))},
      {"t_d: fully open", "then released",
       fmt::format("hinge at most {} rad (limit 1.75)",
                   number(look.over("hinge_rad", 0.0, look.end()).most, 4))},
      {"t_e: slams shut", "at the configured velocity limit",
       fmt::format("fastest {} rad/s (limit -1.2), from {} s on",
                   number(look.over("hinge_rad_per_s", d, look.end()).least, 4), number(e, 2))},
      {"locked", "shaded in Fig. 9", phases_text(look.table().locked())},
  };
}

/// Closest approach of the hand to a checkpoint between two times.
struct Approach {
  double distance = std::numeric_limits<double>::quiet_NaN(), azimuth = distance, time_s = distance;
};

Approach approach(const RunTable& table, const Eigen::Vector3d& place, double from_s, double to_s) {
  Approach nearest;
  const RowRange rows = table.between(from_s, to_s);
  const auto &x = table["hand_x_m"], &y = table["hand_y_m"], &azimuth = table["hand_azimuth_rad"];
  for (std::size_t row = rows.begin; row < rows.end; ++row) {
    const double distance = std::hypot(x[row] - place.x(), y[row] - place.y());
    if (!(distance < nearest.distance) && !std::isnan(nearest.distance)) continue;
    const double turn = std::remainder(azimuth[row] - place.z(), 2.0 * std::numbers::pi);
    nearest = {distance, std::abs(turn), table["time_s"][row]};
  }
  return nearest;
}

// length of the hand's path in the plane
double path_length(const RunTable& table, double from_s, double to_s) {
  const RowRange rows = table.between(from_s, to_s);
  const auto &x = table["hand_x_m"], &y = table["hand_y_m"];
  double length = 0.0;
  for (std::size_t row = rows.begin + 1; row < rows.end; ++row) {
    length += std::hypot(x[row] - x[row - 1], y[row] - y[row - 1]);
  }
  return length;
}

std::vector<Statement> measure_path(ExperimentResult& result) {
  const RunTable& table = *result.table;
  const Look look(result);
  std::vector<Statement> statements;
  double straight = 0.0, last_s = 0.0;
  const Eigen::Vector3d* last = nullptr;
  for (std::size_t i = 0; i < result.events.size(); ++i) {
    const EventResult& event = result.events[i];
    const Eigen::Vector3d& place = event.rule->all_of.front().place;
    if (last != nullptr) straight += (place - *last).head<2>().norm();
    last = &place;
    const bool has_next = i + 1 < result.events.size() && result.events[i + 1].found_s;
    const Approach nearest =
        event.found_s
            ? approach(table, place, last_s, has_next ? *result.events[i + 1].found_s : look.end())
            : Approach{};
    last_s = event.found_s.value_or(last_s);
    statements.push_back(
        {event.rule->name, "reached (marked on the ground)",
         fmt::format("within {} cm and {} degrees at {} s", number(100.0 * nearest.distance, 1),
                     number(kDegrees * nearest.azimuth, 1), number(nearest.time_s, 1))});
    if (nearest.distance > kPathReached_m) {
      result.failures.push_back(fmt::format("{} was passed at {:.1f} cm, expected within {:.0f} cm",
                                            event.rule->name, 100.0 * nearest.distance,
                                            100.0 * kPathReached_m));
    }
  }
  const double from_s = look.t("checkpoint 1"), to_s = look.t("checkpoint 6");
  const double length = from_s < to_s ? path_length(table, from_s, to_s) : std::nan("");
  const LimitForces forces = limit_forces(table);
  statements.push_back(
      {"from the first to the last", "",
       fmt::format("{} s, {} m, {} times the straight lines", number(to_s - from_s, 1),
                   number(length, 2), number(length / straight, 3))});
  statements.push_back(
      {"at limits", "participants have to adapt to the Cartesian limits",
       fmt::format(
           "{:.0f} % of the time; mean force {:.1f} N, at most {:.1f} N (free: mean {:.1f} N)",
           100.0 * forces.felt_share, forces.felt_mean, forces.felt_most, forces.free_mean)});
  return statements;
}

}  // namespace

std::vector<Statement> measure(ExperimentResult& result) {
  const Look look(result);
  std::vector<Statement> statements;
  if (result.experiment->name == "cartesian") statements = measure_cartesian(look);
  if (result.experiment->name == "excavator") statements = measure_excavator(look);
  if (result.experiment->name == "door") statements = measure_door(look);
  if (result.experiment->name == "path") statements = measure_path(result);
  statements.push_back(
      {"hand and twin apart", "",
       fmt::format("at most {} mm",
                   number(1e3 * look.over("hand_to_twin_m", 0.0, look.end()).most, 3))});
  return statements;
}

}  // namespace hg::apps
