// stairwright_player: carries out a plan file on a robot, see README.md of the bundle that it came in.
#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <stdexcept>

#include "stairwright/player/player.hpp"
#include "udp_link.hpp"

using namespace stairwright::player;

namespace {

constexpr char kUsage[] =
    "usage: stairwright_player PLAN.txt [--check | --dry-run] [--listen ADDRESS] [--port PORT]\n"
    "                          [--timeout S] [--wait S] [--stand S]\n"
    "  --check     read the plan, say what is in it, and end\n"
    "  --dry-run   listen and compute, but send nothing; the plan does not advance\n"
    "  --listen    where states come in (127.0.0.1), --port (9100)\n"
    "  --timeout   s without a new state until motors only damp (0.02)\n"
    "  --wait      s to wait for the first state (30)\n"
    "  --stand     s to stand at the end before motors only damp (until a signal)\n"
    "Ctrl-C once: the robot goes no further and stands; twice, or SIGTERM: motors only damp.\n"
    "Exit status: 0 arrived, 1 gave up or refused, 2 bad input, 3 beyond a limit or no state, 128 + signal.\n";

constexpr double kDamping = 1.0;      // s for which commands to damp are sent at the end
constexpr double kPeriod = 0.002;     // s between them
constexpr double kStands = 1.0;       // s that a robot which gave up must stand before it counts as done
enum Exit { kArrived = 0, kGaveUp = 1, kBadInput = 2, kBeyond = 3 };

volatile std::sig_atomic_t interrupts = 0, terminated = 0;
void on_interrupt(int) { interrupts = interrupts + 1; }
void on_terminate(int) { terminated = 1; }

struct Options {
    const char* plan = nullptr;
    bool check = false, dry_run = false;
    std::string address = "127.0.0.1";
    double port = 9100, timeout = 0.02, wait = 30.0, stand = 1e9;
};

Options parse(int count, char** words) {
    Options out;
    for (int i = 1; i < count; ++i) {
        const std::string word = words[i];
        const auto value = [&] {
            if (++i >= count) throw std::invalid_argument(word + " takes a value");
            return words[i];
        };
        const auto number = [&](double most) {
            char* end = nullptr;
            const char* text = value();
            const double x = std::strtod(text, &end);
            if (end == text || *end != '\0' || !(x >= 0.0 && x <= most)) throw std::invalid_argument(word + " takes a number from 0 on");
            return x;
        };
        if (word == "--check") out.check = true;
        else if (word == "--dry-run") out.dry_run = true;
        else if (word == "--listen") out.address = value();
        else if (word == "--port") out.port = number(65535);
        else if (word == "--timeout") out.timeout = number(1e3);
        else if (word == "--wait") out.wait = number(1e9);
        else if (word == "--stand") out.stand = number(1e9);
        else if (word.starts_with("-") || out.plan != nullptr) throw std::invalid_argument("what is " + word + "?");
        else out.plan = words[i];
    }
    if (out.plan == nullptr) throw std::invalid_argument("name a plan file");
    return out;
}

PlanFile read(const char* path) {
    std::ifstream text(path);
    if (!text) throw std::runtime_error("cannot be read");
    return read_plan_file(text);
}

void describe(const PlanFile& file) {
    const auto& last = file.rows.back().value;
    std::printf("plan %s: %zu vertices, %zu set points, to x %.2f m, height %.2f m; friction %.2f; robot of %.2f kg\n", file.plan.c_str(),
                file.terrain.size(), file.rows.size(), last.trunk.x, last.trunk.z, file.friction, file.robot.mass());
    const char* kinds[] = {"none", "drive", "hold"};
    for (std::size_t k = 0; k < kMotors; ++k)
        std::printf("motor %2zu %-10s %s\n", k, file.motors[k].name.c_str(), kinds[static_cast<int>(file.motors[k].kind)]);
}

using Clock = std::chrono::steady_clock;
double since(Clock::time_point then) { return std::chrono::duration<double>(Clock::now() - then).count(); }

void report(const Player& player, double time) {
    const auto [leg, wheel] = player.largest_torques();
    std::printf("%7.2f s  %-8s  %5.1f %%  pitch %6.3f rad  legs %5.1f Nm  wheels %4.1f Nm\n", time, name(player.phase()),
                100.0 * player.done(), player.pitch(), leg, wheel);
    std::fflush(stdout);
}

// Lets the joints sink, whatever comes in or does not.
void bring_to_rest(UdpLink& link, const Player& player) {
    for (const auto begin = Clock::now(); since(begin) < kDamping;) {
        link.send(player.damped());
        link.receive(kPeriod);
    }
}

// What the plan is not for.
void tell(const stairwright::control::Load& load) {
    if (load.mass > 0.0)
        std::printf("it carries %.1f kg that the plan is not for\n", load.mass);
    else
        std::printf("its mass centre is (%.0f, %.0f) mm from where the plan has it\n", 1e3 * load.shift.x, 1e3 * load.shift.z);
}

// How it ended.
int play(Player& player, UdpLink& link, const Options& options) {
    double first = 0.0, latest = 0.0, told = -1e9, done_at = 0.0, worst = 0.0, sum = 0.0;
    std::size_t steps = 0;
    bool weighed = false;
    auto heard = Clock::now();
    while (player.phase() != Phase::damped && player.phase() != Phase::refused) {
        if (terminated || interrupts > 1) player.damp("told to stop");
        if (interrupts == 1) player.pause();
        const double patience = steps == 0 ? options.wait : options.timeout;
        const std::optional<LowState> state = link.receive(std::min(patience, 0.1));
        // A state that repeats the last one's time is a robot that no longer looks.
        if (state && (steps == 0 || state->time != latest)) {
            heard = Clock::now();
            if (steps == 0) first = state->time;
            latest = state->time;
            const LowCommand& command = player.step(*state);
            if (!options.dry_run && player.phase() != Phase::refused) link.send(command);
            const double took = since(heard);
            worst = std::max(worst, took), sum += took, ++steps;
            if (player.load() && !weighed) tell(*player.load()), weighed = true;
            if (latest - told >= 1.0) report(player, latest - first), told = latest;
        } else if (since(heard) >= patience) {
            char text[80];
            std::snprintf(text, sizeof text, "no new state for %.3g s", patience);
            player.damp(text);
        }
        const bool done = player.phase() == Phase::arrived || player.phase() == Phase::gave_up;
        if (!done) done_at = latest;
        else if (latest - done_at >= std::max(options.stand, player.phase() == Phase::gave_up ? kStands : 0.0)) break;
    }
    const Phase ended = player.phase();
    if (steps > 0 && ended != Phase::damped) report(player, latest - first);
    if (!options.dry_run && ended != Phase::refused) bring_to_rest(link, player);
    std::printf("%s\n", player.reason().c_str());
    if (steps > 0)
        std::printf("%zu steps of %.0f us on average, %.0f us at most\n", steps, 1e6 * sum / static_cast<double>(steps), 1e6 * worst);
    if (terminated) return 128 + SIGTERM;
    if (interrupts > 1) return 128 + SIGINT;
    if (ended == Phase::damped) return kBeyond;
    return ended == Phase::arrived ? kArrived : kGaveUp;
}

}  // namespace

int main(int count, char** words) {
    Options options;
    try {
        options = parse(count, words);
    } catch (const std::invalid_argument& error) {
        std::fprintf(stderr, "%s\n%s", error.what(), kUsage);
        return kBadInput;
    }
    try {
        PlanFile file = read(options.plan);
        if (options.check) return describe(file), 0;
        Player player(std::move(file));
        if (options.dry_run) player.pause();
        UdpLink link(options.address, static_cast<std::uint16_t>(options.port));
        std::signal(SIGINT, on_interrupt);
        std::signal(SIGTERM, on_terminate);
        return play(player, link, options);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s: %s\n", options.plan, error.what());
        return kBadInput;
    }
}
