//! Addresses in the memory of a slave controller (ETG.1000.4; names as in data sheets of ESCs).

pub const TYPE: u16 = 0x0000;
pub const BUILD: u16 = 0x0002;
pub const FMMU_COUNT: u16 = 0x0004;
pub const SYNC_MANAGER_COUNT: u16 = 0x0005;
pub const RAM_KIB: u16 = 0x0006;
pub const PORT_DESCRIPTOR: u16 = 0x0007;
pub const FEATURES: u16 = 0x0008;
pub const STATION_ADDRESS: u16 = 0x0010;
pub const STATION_ALIAS: u16 = 0x0012;
pub const DL_STATUS: u16 = 0x0110;
pub const AL_CONTROL: u16 = 0x0120;
pub const AL_STATUS: u16 = 0x0130;
pub const AL_STATUS_CODE: u16 = 0x0134;
pub const RX_ERRORS: u16 = 0x0300;
pub const LOST_LINKS: u16 = 0x0310;
pub const WATCHDOG_DIVIDER: u16 = 0x0400;
pub const WATCHDOG_TIME: u16 = 0x0420;
pub const WATCHDOG_STATUS: u16 = 0x0440;
pub const WATCHDOG_COUNTER: u16 = 0x0442;
pub const EEPROM_CONTROL: u16 = 0x0502;
pub const EEPROM_ADDRESS: u16 = 0x0504;
pub const EEPROM_DATA: u16 = 0x0508;
pub const FMMUS: u16 = 0x0600;
pub const SYNC_MANAGERS: u16 = 0x0800;
pub const RECEIVE_TIMES: u16 = 0x0900;
pub const SYSTEM_TIME: u16 = 0x0910;
pub const UNIT_RECEIVE_TIME: u16 = 0x0918;
pub const TIME_OFFSET: u16 = 0x0920;
pub const TIME_DELAY: u16 = 0x0928;
pub const TIME_DIFFERENCE: u16 = 0x092C;
pub const SPEED_COUNTER: u16 = 0x0930;
pub const SYNC_ACTIVATION: u16 = 0x0981;
pub const SYNC_STATUS: u16 = 0x0984;
pub const SYNC_START: u16 = 0x0990; // read: the next pulse
pub const SYNC0_CYCLE: u16 = 0x09A0;
pub const RAM: u16 = 0x1000;

pub const FMMU_TOTAL: u16 = 8;
pub const FMMU_BYTES: u16 = 16;
pub const SYNC_MANAGER_TOTAL: u16 = 4;
pub const SYNC_MANAGER_BYTES: u16 = 8;

/// What a master may write (first and last address); writing the rest changes nothing.
pub const WRITABLE: [(u16, u16); 15] = [
    (0x0010, 0x0011), // station address
    (0x0100, 0x0103), // data link control
    (0x0120, 0x0121), // AL control
    (0x0200, 0x0201), // event mask
    (0x0400, 0x0401), // watchdog divider
    (0x0410, 0x0411), // watchdog of the application
    (0x0420, 0x0421), // watchdog of process data
    (0x0500, 0x0500), // owner of the EEPROM
    (0x0502, 0x050F), // command, address and data of the EEPROM
    (0x0600, 0x067F), // FMMUs
    (0x0920, 0x092B), // offset and delay of the clock
    (0x0930, 0x0931), // speed counter
    (0x0934, 0x0935), // filters of the clock
    (0x0980, 0x0983), // sync pulses
    (0x0990, 0x09A7), // their times
];
