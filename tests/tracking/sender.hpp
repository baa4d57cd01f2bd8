// Sends UDP packets to a port of this machine, like a tracker.
#pragma once

#include <netinet/in.h>

#include <string>

namespace bolt::test {

class UdpSender {
  public:
    explicit UdpSender(int port);
    UdpSender(const UdpSender&) = delete;
    UdpSender& operator=(const UdpSender&) = delete;
    ~UdpSender();
    void send(const std::string& packet) const;

  private:
    int socket_;
    sockaddr_in address_{};
};

}  // namespace bolt::test
