//! Units of measurement that a field may have.

use crate::vocabulary::Meaning;

/// The symbols, as pages print them, each with its meaning.
pub(crate) static UNITS: &[Meaning] = &[
    ("us", "Microseconds.", "微秒。"),
    ("ms", "Milliseconds.", "毫秒。"),
    ("s", "Seconds.", "秒。"),
    ("min", "Minutes.", "分钟。"),
    ("h", "Hours.", "小时。"),
    ("d", "Days.", "天。"),
    ("%", "Hundredths.", "百分之一。"),
    ("‰", "Thousandths.", "千分之一。"),
    ("um", "Micrometres.", "微米。"),
    ("mm", "Millimetres.", "毫米。"),
    ("cm", "Centimetres.", "厘米。"),
    ("m", "Metres.", "米。"),
    ("km", "Kilometres.", "千米。"),
    ("m²", "Square metres.", "平方米。"),
    ("m³", "Cubic metres.", "立方米。"),
    ("mL", "Millilitres.", "毫升。"),
    ("L", "Litres.", "升。"),
    ("deg", "Degrees of an angle.", "角度。"),
    ("rad", "Radians.", "弧度。"),
    ("mm/s", "Millimetres per second.", "毫米每秒。"),
    ("cm/s", "Centimetres per second.", "厘米每秒。"),
    ("m/s", "Metres per second.", "米每秒。"),
    ("km/h", "Kilometres per hour.", "千米每小时。"),
    ("m/s²", "Metres per second squared.", "米每二次方秒。"),
    ("deg/s", "Degrees per second.", "度每秒。"),
    ("rad/s", "Radians per second.", "弧度每秒。"),
    ("r/min", "Turns per minute.", "转每分钟。"),
    ("g", "Grams.", "克。"),
    ("kg", "Kilograms.", "千克。"),
    ("N", "Newtons; quote it.", "牛顿，要加引号。"),
    ("N·m", "Newton metres.", "牛顿米。"),
    ("Pa", "Pascals.", "帕。"),
    ("hPa", "Hectopascals.", "百帕。"),
    ("kPa", "Kilopascals.", "千帕。"),
    ("℃", "Degrees Celsius.", "摄氏度。"),
    ("K", "Kelvins.", "开尔文。"),
    ("mV", "Millivolts.", "毫伏。"),
    ("V", "Volts.", "伏。"),
    ("mA", "Milliamperes.", "毫安。"),
    ("A", "Amperes.", "安。"),
    ("mAh", "Milliampere hours.", "毫安时。"),
    ("Ah", "Ampere hours.", "安时。"),
    ("mW", "Milliwatts.", "毫瓦。"),
    ("W", "Watts.", "瓦。"),
    ("Wh", "Watt hours.", "瓦时。"),
    ("Ω", "Ohms.", "欧姆。"),
    ("Hz", "Hertz.", "赫兹。"),
    ("kHz", "Kilohertz.", "千赫。"),
    ("MHz", "Megahertz.", "兆赫。"),
    ("bit", "Bits.", "比特。"),
    ("B", "Bytes.", "字节。"),
    ("KiB", "1024 bytes.", "1024 字节。"),
    ("MiB", "1024 KiB.", "1024 KiB。"),
    ("GiB", "1024 MiB.", "1024 MiB。"),
    ("bit/s", "Bits per second.", "比特每秒。"),
    ("B/s", "Bytes per second.", "字节每秒。"),
    ("KiB/s", "1024 bytes per second.", "每秒 1024 字节。"),
    ("px", "Pixels.", "像素。"),
    ("dB", "Decibels.", "分贝。"),
    ("dBm", "Decibels over one milliwatt.", "分贝毫瓦。"),
    ("lx", "Lux.", "勒克斯。"),
];

/// The units of length. They include pixels, because positions in a picture are counted in pixels.
const LENGTHS: [&str; 6] = ["um", "mm", "cm", "m", "km", "px"];

/// Returns `true` if the unit can measure positions.
pub(crate) fn is_length(unit: &str) -> bool {
    LENGTHS.contains(&unit)
}

/// Other names of units.
static OTHER_NAMES: &[(&str, &str)] = &[
    ("µs", "us"),
    ("μs", "us"),
    ("microsecond", "us"),
    ("msec", "ms"),
    ("millisecond", "ms"),
    ("毫秒", "ms"),
    ("sec", "s"),
    ("second", "s"),
    ("秒", "s"),
    ("minute", "min"),
    ("分钟", "min"),
    ("hour", "h"),
    ("hr", "h"),
    ("小时", "h"),
    ("day", "d"),
    ("天", "d"),
    ("percent", "%"),
    ("百分比", "%"),
    ("millimeter", "mm"),
    ("millimetre", "mm"),
    ("毫米", "mm"),
    ("centimeter", "cm"),
    ("centimetre", "cm"),
    ("厘米", "cm"),
    ("meter", "m"),
    ("metre", "m"),
    ("米", "m"),
    ("kilometer", "km"),
    ("kilometre", "km"),
    ("千米", "km"),
    ("公里", "km"),
    ("m2", "m²"),
    ("m3", "m³"),
    ("m/s2", "m/s²"),
    ("m/s^2", "m/s²"),
    ("mps", "m/s"),
    ("米/秒", "m/s"),
    ("km/hour", "km/h"),
    ("degree", "deg"),
    ("°", "deg"),
    ("度", "deg"),
    ("radian", "rad"),
    ("弧度", "rad"),
    ("rpm", "r/min"),
    ("gram", "g"),
    ("克", "g"),
    ("kilogram", "kg"),
    ("千克", "kg"),
    ("公斤", "kg"),
    ("newton", "N"),
    ("celsius", "℃"),
    ("°C", "℃"),
    ("摄氏度", "℃"),
    ("volt", "V"),
    ("伏", "V"),
    ("ampere", "A"),
    ("amp", "A"),
    ("安", "A"),
    ("watt", "W"),
    ("瓦", "W"),
    ("ohm", "Ω"),
    ("byte", "B"),
    ("字节", "B"),
    ("kb", "KiB"),
    ("mb", "MiB"),
    ("gb", "GiB"),
    ("pixel", "px"),
    ("像素", "px"),
    ("lux", "lx"),
];

/// Returns the unit for another name, such as `seconds`, `°C` or `MS`.
pub(crate) fn meant(name: &str) -> Option<&'static str> {
    let lower = name.to_lowercase();
    let singular = lower.strip_suffix('s').unwrap_or(&lower);
    let other = OTHER_NAMES.iter().find(|(other, _)| {
        let other = other.to_lowercase();
        other == lower || other == singular
    });
    let spelt = || UNITS.iter().find(|(unit, ..)| unit.to_lowercase() == lower);
    other
        .map(|(_, unit)| *unit)
        .or_else(|| spelt().map(|(unit, ..)| *unit))
}
