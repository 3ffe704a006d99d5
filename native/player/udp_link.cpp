#include "udp_link.hpp"

#include <arpa/inet.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <bit>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <system_error>

namespace stairwright::player {

namespace {

static_assert(std::endian::native == std::endian::little, "packets are little-endian");

#pragma pack(push, 1)
struct StatePacket {
    char kind[4];
    std::uint32_t sequence;
    double time;
    float gyro[3], accelerometer[3];
    float motors[kMotors][3];
};
struct CommandPacket {
    char kind[4];
    std::uint32_t sequence;
    float motors[kMotors][5];
};
#pragma pack(pop)
static_assert(sizeof(StatePacket) == 232 && sizeof(CommandPacket) == 328);

LowState state_of(const StatePacket& p) {
    LowState out;
    out.time = p.time;
    for (int i = 0; i < 3; ++i) out.gyro[i] = p.gyro[i], out.accelerometer[i] = p.accelerometer[i];
    for (std::size_t k = 0; k < kMotors; ++k) out.motors[k] = {p.motors[k][0], p.motors[k][1], p.motors[k][2]};
    return out;
}

}  // namespace

UdpLink::UdpLink(const std::string& address, std::uint16_t port) : socket_(::socket(AF_INET, SOCK_DGRAM, 0)) {
    if (socket_ < 0) throw std::system_error(errno, std::generic_category(), "no socket");
    sockaddr_in own{};
    own.sin_family = AF_INET, own.sin_port = htons(port);
    const bool known = ::inet_pton(AF_INET, address.c_str(), &own.sin_addr) == 1;
    if (!known) errno = EADDRNOTAVAIL;
    if (!known || ::bind(socket_, reinterpret_cast<const sockaddr*>(&own), sizeof own) != 0) {
        const int error = errno;
        ::close(socket_);
        throw std::system_error(error, std::generic_category(), "cannot listen on " + address);
    }
}

UdpLink::~UdpLink() { ::close(socket_); }

std::optional<LowState> UdpLink::receive(double patience) {
    std::optional<LowState> newest;
    pollfd waiting = {socket_, POLLIN, 0};
    if (::poll(&waiting, 1, static_cast<int>(std::ceil(1000.0 * patience))) <= 0) return newest;
    for (;;) {
        StatePacket packet;
        sockaddr_in from{};
        socklen_t size = sizeof from;
        const ssize_t got = ::recvfrom(socket_, &packet, sizeof packet, MSG_DONTWAIT | MSG_TRUNC, reinterpret_cast<sockaddr*>(&from), &size);
        if (got < 0) return newest;
        if (got != sizeof packet || std::memcmp(packet.kind, "SWS1", 4) != 0) continue;
        const bool first = !robot_;
        if (first) robot_ = from;
        if (robot_->sin_addr.s_addr != from.sin_addr.s_addr || robot_->sin_port != from.sin_port) continue;
        // Packets may overtake one another.
        if (!first && static_cast<std::int32_t>(packet.sequence - sequence_) <= 0) continue;
        sequence_ = packet.sequence;
        newest = state_of(packet);
    }
}

void UdpLink::send(const LowCommand& command) {
    if (!robot_) return;
    CommandPacket packet = {{'S', 'W', 'C', '1'}, sequence_, {}};
    for (std::size_t k = 0; k < kMotors; ++k) {
        const MotorCommand& m = command.motors[k];
        const double values[] = {m.q, m.dq, m.tau, m.kp, m.kd};
        for (int i = 0; i < 5; ++i) packet.motors[k][i] = static_cast<float>(values[i]);
    }
    // What is lost is lost: the next one comes in 2 ms, and the robot's own watchdog sees to the rest.
    ::sendto(socket_, &packet, sizeof packet, MSG_DONTWAIT, reinterpret_cast<const sockaddr*>(&*robot_), sizeof *robot_);
}

}  // namespace stairwright::player
