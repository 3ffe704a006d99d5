#include "stairwright/player/plan_file.hpp"

#include <bit>
#include <cmath>
#include <map>
#include <sstream>
#include <stdexcept>

namespace stairwright::player {

namespace {

using Numbers = std::vector<double>;

// The lines of a file by key; what is read is ticked off, so that nothing unknown is passed over.
class Lines {
  public:
    explicit Lines(std::istream& text) {
        std::string line;
        if (!std::getline(text, line) || line != "stairwright-player 1")
            throw std::runtime_error("line 1: must be: stairwright-player 1");
        for (int number = 2; std::getline(text, line); ++number) {
            std::istringstream words(line);
            std::string key, rest;
            if (!(words >> key) || key.front() == '#') continue;
            std::getline(words >> std::ws, rest);
            entries_[key].push_back({number, rest});
        }
    }

    std::string text(const std::string& key) { return one(key).rest; }
    Numbers numbers(const std::string& key, std::size_t count) {
        const Entry entry = one(key);
        return parsed(key, entry, count);
    }
    double number(const std::string& key) { return numbers(key, 1)[0]; }
    bool has(const std::string& key) const { return entries_.contains(key); }
    std::vector<Numbers> table(const std::string& key, std::size_t count) {
        std::vector<Numbers> out;
        for (const Entry& entry : take(key)) out.push_back(parsed(key, entry, count));
        return out;
    }
    struct Entry {
        int line = 0;
        std::string rest;
    };
    std::vector<Entry> take(const std::string& key) {
        const auto found = entries_.extract(key);
        if (found.empty()) throw std::runtime_error("no line: " + key);
        return found.mapped();
    }
    void end() const {
        if (!entries_.empty()) fail(entries_.begin()->second.front(), "unknown: " + entries_.begin()->first);
    }
    [[noreturn]] static void fail(const Entry& entry, const std::string& why) {
        throw std::runtime_error("line " + std::to_string(entry.line) + ": " + why);
    }

  private:
    Entry one(const std::string& key) {
        const std::vector<Entry> found = take(key);
        if (found.size() > 1) fail(found[1], "a second " + key);
        return found.front();
    }
    static Numbers parsed(const std::string& key, const Entry& entry, std::size_t count) {
        std::istringstream words(entry.rest);
        Numbers out;
        for (double value; words >> value;) out.push_back(value);
        bool good = words.eof() && out.size() == count;
        for (const double value : out) good = good && std::isfinite(value);
        if (!good) fail(entry, key + " takes " + std::to_string(count) + " numbers");
        return out;
    }

    std::map<std::string, std::vector<Entry>> entries_;
};

// Place of the next joint (x, z), of the mass centre (x, z), mass, moment of inertia.
Link link(const Numbers& n) { return {{n[0], n[1]}, {n[2], n[3]}, n[4], n[5], {}}; }
// Torque, no-load speed, rotor inertia.
Motor motor(const Numbers& n) { return {n[0], n[1], n[2], n[3]}; }

Leg leg(Lines& lines, const std::string& pair) {
    const auto numbers = [&](const char* key, std::size_t count) { return lines.numbers(pair + "." + key, count); };
    Leg out;
    const Numbers hip = numbers("hip", 2), wheel = numbers("wheel", 3), knee = numbers("knee", 1);
    const Numbers thigh_range = numbers("thigh_range", 2), calf_range = numbers("calf_range", 2);
    out.hip = {hip[0], hip[1]};
    out.thigh = link(numbers("thigh", 6)), out.calf = link(numbers("calf", 6));
    out.wheel = {wheel[0], wheel[1], wheel[2]};  // radius, mass, moment of inertia
    out.thigh_range = {thigh_range[0], thigh_range[1]}, out.calf_range = {calf_range[0], calf_range[1]};
    out.thigh_motor = motor(numbers("thigh_motor", 4)), out.calf_motor = motor(numbers("calf_motor", 4));
    out.wheel_motor = motor(numbers("wheel_motor", 4));
    out.knee = knee[0];
    return out;
}

Robot robot(Lines& lines) {
    Robot out;
    const Numbers trunk = lines.numbers("trunk", 4);  // mass, moment of inertia, mass centre (x, z)
    out.trunk = {trunk[0], trunk[1], {trunk[2], trunk[3]}, {}};
    out.legs = {leg(lines, "front"), leg(lines, "rear")};
    out.half_track = lines.number("half_track"), out.nominal_height = lines.number("nominal_height");
    if (!(out.mass() > 0.0) || !(out.legs[0].wheel.radius > 0.0)) throw std::runtime_error("masses and radii must be positive");
    return out;
}

control::Gains gains(Lines& lines) {
    control::Gains g;
    const std::pair<const char*, double*> all[] = {
        {"joint_stiffness", &g.joint_stiffness}, {"joint_damping", &g.joint_damping}, {"wheel_damping", &g.wheel_damping},
        {"wheel_sync", &g.wheel_sync}, {"yaw_damping", &g.yaw_damping}, {"heading_stiffness", &g.heading_stiffness},
        {"com_stiffness", &g.com_stiffness}, {"com_damping", &g.com_damping}, {"pitch_stiffness", &g.pitch_stiffness},
        {"pitch_damping", &g.pitch_damping}, {"pitch_integral", &g.pitch_integral}, {"roll_stiffness", &g.roll_stiffness},
        {"roll_damping", &g.roll_damping}, {"force_weight", &g.force_weight}, {"moment_weight", &g.moment_weight},
        {"alpha", &g.alpha}, {"beta", &g.beta}, {"friction_share", &g.friction_share}, {"force_limit", &g.force_limit}};
    for (const auto& [name, value] : all) *value = lines.number(std::string("gain.") + name);
    return g;
}

std::array<MotorRole, kMotors> motors(Lines& lines) {
    std::array<MotorRole, kMotors> out;
    std::array<bool, kMotors> seen{};
    std::array<bool, 12> driven{};
    for (const Lines::Entry& entry : lines.take("motor")) {
        std::istringstream words(entry.rest);
        std::size_t index = kMotors;
        MotorRole role;
        std::string kind;
        words >> index >> role.name >> kind;
        if (!words || index >= kMotors || seen[index]) Lines::fail(entry, "a motor takes a number of its own below 16, a name and a kind");
        seen[index] = true;
        if (kind == "drive") {
            role.kind = MotorRole::Kind::drive;
            words >> role.joint >> role.sign >> role.offset;
            if (!words || role.joint >= 12 || std::abs(role.sign) != 1.0 || !std::isfinite(role.offset) || driven[role.joint])
                Lines::fail(entry, "drive takes a joint of its own below 12, a sign of 1 or -1 and an offset");
            driven[role.joint] = true;
        } else if (kind == "hold") {
            role.kind = MotorRole::Kind::hold;
            words >> role.angle;
            if (!words || !std::isfinite(role.angle)) Lines::fail(entry, "hold takes an angle");
        } else if (kind != "none") {
            Lines::fail(entry, "a motor's kind is drive, hold or none");
        }
        out[index] = role;
    }
    for (std::size_t j = 0; j < driven.size(); ++j)
        if (!driven[j]) throw std::runtime_error("no motor drives joint " + std::to_string(j));
    return out;
}

}  // namespace

PlanFile read_plan_file(std::istream& text) {
    Lines lines(text);
    PlanFile out;
    out.plan = lines.text("plan");
    out.friction = lines.number("friction");
    out.facing = lines.has("facing") ? lines.number("facing") : 1.0;  // older files have none
    out.robot = robot(lines);
    out.gains = gains(lines);
    out.motors = motors(lines);
    out.position = lines.number("way"), out.step = lines.number("step"), out.lead = lines.number("lead");
    out.settle = lines.number("settle");
    const Numbers grip = lines.numbers("grip", 2), hold = lines.numbers("hold", 2);
    out.grip_need = grip[0], out.grip_enough = grip[1];
    out.hold_stiffness = hold[0], out.hold_damping = hold[1];
    for (const Numbers& p : lines.table("vertex", 2)) out.terrain.push_back({p[0], p[1]});
    for (const Numbers& row : lines.table("row", 1 + control::kReferenceWidth)) {
        std::array<double, control::kReferenceWidth> numbers;
        std::copy(row.begin() + 1, row.end(), numbers.begin());
        out.speeds.push_back(row[0]);
        out.rows.push_back(std::bit_cast<control::Reference>(numbers));
    }
    lines.end();
    if (std::abs(out.facing) != 1.0) throw std::runtime_error("facing must be 1 or -1");
    if (!(out.friction > 0.0) || !(out.settle >= 0.0)) throw std::runtime_error("friction must be positive, settle not negative");
    return out;
}

}  // namespace stairwright::player
