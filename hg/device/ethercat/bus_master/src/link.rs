//! A raw socket for EtherCAT frames on one network interface.

use std::ffi::CString;
use std::io::{Error, Result};
use std::mem::{size_of, zeroed};
use std::os::fd::{AsRawFd, FromRawFd, OwnedFd, RawFd};

const ETHERCAT: u16 = 0x88A4;
const MOST_BYTES: usize = 1536;

pub struct Link {
    socket: OwnedFd,
    buffer: [u8; MOST_BYTES],
}

impl Link {
    pub fn open(interface: &str) -> Result<Link> {
        let name = CString::new(interface)?;
        // SAFETY: plain system calls; the descriptor has one owner, the address is a valid one
        unsafe {
            let index = libc::if_nametoindex(name.as_ptr());
            if index == 0 {
                return Err(Error::last_os_error());
            }
            let kind = libc::SOCK_RAW | libc::SOCK_CLOEXEC | libc::SOCK_NONBLOCK;
            let socket = libc::socket(libc::AF_PACKET, kind, i32::from(ETHERCAT.to_be()));
            if socket < 0 {
                return Err(Error::last_os_error());
            }
            let socket = OwnedFd::from_raw_fd(socket);
            let mut address: libc::sockaddr_ll = zeroed();
            address.sll_family = libc::AF_PACKET as u16;
            address.sll_protocol = ETHERCAT.to_be();
            address.sll_ifindex = index as i32;
            let size = size_of::<libc::sockaddr_ll>() as u32;
            if libc::bind(socket.as_raw_fd(), std::ptr::from_ref(&address).cast(), size) < 0 {
                return Err(Error::last_os_error());
            }
            Ok(Link { socket, buffer: [0; MOST_BYTES] })
        }
    }

    pub fn descriptor(&self) -> RawFd {
        self.socket.as_raw_fd()
    }

    /// The next frame that came in; None: there is none at the moment.
    pub fn receive(&mut self) -> Result<Option<&mut [u8]>> {
        loop {
            // SAFETY: buffer and address are as large as the call is given
            let (length, direction) = unsafe {
                let mut from: libc::sockaddr_ll = zeroed();
                let mut size = size_of::<libc::sockaddr_ll>() as u32;
                let length = libc::recvfrom(
                    self.descriptor(),
                    self.buffer.as_mut_ptr().cast(),
                    MOST_BYTES,
                    0,
                    std::ptr::from_mut(&mut from).cast(),
                    &mut size,
                );
                (length, from.sll_pkttype)
            };
            if length < 0 {
                let error = Error::last_os_error();
                return match error.raw_os_error() {
                    Some(libc::EAGAIN | libc::EINTR) => Ok(None),
                    _ => Err(error),
                };
            }
            if direction != libc::PACKET_OUTGOING {
                return Ok(Some(&mut self.buffer[..length as usize]));
            }
        }
    }

    pub fn send(&self, frame: &[u8]) -> Result<()> {
        // SAFETY: the frame is as long as the call is given
        let sent = unsafe { libc::send(self.descriptor(), frame.as_ptr().cast(), frame.len(), 0) };
        if sent < 0 {
            Err(Error::last_os_error())
        } else {
            Ok(())
        }
    }
}
