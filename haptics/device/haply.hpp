// Haply's arm Inverse3 through the vendor's service: messages over a WebSocket on this computer
// (haply_messages.hpp). The arm may have a VerseGrip, a handle that senses rotation and has buttons. Not
// tried on hardware.
#pragma once

#include <vector>

#include "haptics/device/device.hpp"
#include "haptics/device/web_socket.hpp"

namespace bolt::device {

// The addresses of the service.
struct HaplyService {
    SocketAddress states{.port = 10001};  // takes forces and sends states
    SocketAddress events{.port = 10020};  // sends events, such as an arm that has braked
};

// The service that BOLTWRIGHT_HAPLY names as ADDRESS:PORT, or the one on this computer. The events have the
// given port plus 19, as with the service's default ports.
Result<HaplyService> haply_service();

struct HaplyListing {
    std::string arm;             // its id at the service
    std::optional<Error> error;  // why it cannot be used
};

// The arms that the service has now; none if no service answers within `timeout` s. An error means that a
// service answers with something that cannot be used.
Result<std::vector<HaplyListing>> list_haply(const HaplyService& service, double timeout);

// Opens the service's arm `index`, from 0, with the grip of the same index if there is one. Fails if the arm
// is not calibrated. A thread exchanges messages with the service: one force, then one state, at most every
// millisecond. `timer` measures the age of a force: a force older than 20 ms is replaced by zero.
Result<std::unique_ptr<DeviceDriver>> open_haply(const HaplyService& service, int index, Timer timer);

}  // namespace bolt::device
