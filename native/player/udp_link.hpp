// The robot at the other end of a UDP socket: a state comes in as one packet, the answer goes to where it came from.
//
// Both packets are little-endian and packed:
//   state    "SWS1", u32 sequence, f64 time, f32 gyro[3], f32 accelerometer[3], 16 times f32 q, dq, tau      232 bytes
//   command  "SWC1", u32 sequence of the state that it answers, 16 times f32 q, dq, tau, kp, kd              328 bytes
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include <netinet/in.h>

#include "stairwright/player/low_level.hpp"

namespace stairwright::player {

class UdpLink {
  public:
    // Listens there; throws std::system_error if that cannot be.
    UdpLink(const std::string& address, std::uint16_t port);
    ~UdpLink();
    UdpLink(const UdpLink&) = delete;
    UdpLink& operator=(const UdpLink&) = delete;

    // The newest state that has come in, waiting for one for `patience` [s] at most. Whoever sends the first state is
    // the robot; packets from elsewhere and those that are no states are dropped.
    std::optional<LowState> receive(double patience);
    // To the robot, once one is known.
    void send(const LowCommand& command);

  private:
    int socket_;
    std::optional<sockaddr_in> robot_;
    std::uint32_t sequence_ = 0;
};

}  // namespace stairwright::player
