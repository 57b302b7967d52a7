//! The table of spellings: how simulators, phones, loggers and flight controllers name their columns, and what a name implies.

use polhode::audit::{Direction, Frame};

/// What a group of columns holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Quantity {
    /// A quaternion whose scalar part is told by its name; it stands first here.
    Quaternion,
    /// A quaternion whose components are numbered: where its scalar part stands is open.
    Numbered,
    /// The nine entries of a rotation matrix, by rows.
    Matrix,
    /// Three Euler angles.
    Angles,
    /// Modified Rodrigues parameters.
    Rodrigues,
    /// An angular velocity.
    Rates,
    /// An angular momentum.
    Momentum,
}

impl Quantity {
    /// In the plural, for messages.
    pub(crate) fn words(self) -> &'static str {
        match self {
            Self::Rates => "angular velocities",
            Self::Momentum => "angular momenta",
            _ => "attitudes",
        }
    }
}

/// Spellings of one quantity: a stem, then a component. Words are separated by blanks, sets of components by bars.
pub(crate) struct Spelling {
    pub(crate) quantity: Quantity,
    stems: &'static str,
    components: &'static str,
    /// Whether these columns are passed over where others hold the quantity too.
    pub(crate) yields: bool,
}

const AXES: &str = "x y z";
const VECTOR: &str = "x y z|1 2 3|0 1 2|i j k";
const LETTERS: &str = "w x y z|s x y z|w i j k";
const NUMBERS: &str = "0 1 2 3|1 2 3 4";
const ENTRIES: &str = "11 12 13 21 22 23 31 32 33|00 01 02 10 11 12 20 21 22|xx xy xz yx yy yz zx zy zz";

/// Without a stem.
const NONE: &str = "-";

/// `qrs` is of EuRoC, `quatq` of Xsens; the last two say what the quaternion takes where.
const QUATERNION: &str = "q quat quaternion orientation orn attitude rotation rot qbn qib ep cquat cq qrs quatq \
    motionquaternion qbodytospace qspacetobody";
const MATRIX: &str = "r rot rotmat rotation dcm matrix mat m a c bn";
const EULER: &str = "phi theta psi|roll pitch yaw|alpha beta gamma";

/// Words for gyroscopes are those of the languages that phyphox speaks; the last are of EuRoC, of sketches for the MPU-6050 and
/// of YEI.
const RATES: &str = "w omega omegabody gyro gyr gyroscope g angularvelocity angularvelocitybody rate angvel angularrate \
    angrate av wbody wb omegab omegabnb wspace wworld omegaspace omegaworld omegabnn omegas gyrodata \
    gyroskop gyroscoop giroscopio giroscópio giroskop żyroskop jiroskop γυροσκόπιο гироскоп 陀螺仪 ジャイロスコープ \
    자이로스코프 winkelgeschwindigkeit vitesseangulaire velocidadangular velocitàangolare wrss gy correctedgyro";

/// Of logs that hold an angular velocity twice: as measured, and as the device has corrected it. The last is of ROS, where
/// `angular` alone may be an acceleration (geometry_msgs/Accel).
const RATES_OF_LOGS: &str = "rotationrate gyrorotation motionrotationrate gyrorad xyz gyroadc fieldangularvelocity \
    imuangularvelocity imugyro sensorangularvelocity twistangular";

/// Axes with what they are of behind them, as in `wx_body`.
const AXES_OF: &str = "xbody ybody zbody|xspace yspace zspace|xworld yworld zworld";

/// The second is of OpenIMU, the third of MAVLink and PX4.
const RATES_WITHOUT_STEM: &str = "p q r|rollrate pitchrate yawrate|rollspeed pitchspeed yawspeed|xaxis yaxis zaxis|\
    xgyro ygyro zgyro|xgyr ygyr zgyr|\
    xgyroscope ygyroscope zgyroscope|xrate yrate zrate|xangularvelocity yangularvelocity zangularvelocity";
const MOMENTA: &str =
    "l angmom angularmomentum h momentum lbody hbody momentumbody lspace hspace momentumspace";

const fn spelling(quantity: Quantity, stems: &'static str, components: &'static str) -> Spelling {
    Spelling { quantity, stems, components, yields: false }
}

const fn yielding(quantity: Quantity, stems: &'static str, components: &'static str) -> Spelling {
    Spelling { quantity, stems, components, yields: true }
}

/// In the order of preference, letters without unit.
pub(crate) const SPELLINGS: &[Spelling] = &[
    spelling(Quantity::Quaternion, QUATERNION, LETTERS),
    spelling(Quantity::Numbered, QUATERNION, NUMBERS),
    // arrays of PX4 as PlotJuggler names them: `vehicle_attitude/q.00`
    spelling(Quantity::Numbered, "q", "00 01 02 03"),
    spelling(Quantity::Matrix, MATRIX, ENTRIES),
    spelling(Quantity::Rodrigues, "sigma sigmabn mrp", VECTOR),
    spelling(Quantity::Angles, "euler angle eulerangle eul", VECTOR),
    spelling(Quantity::Angles, NONE, EULER),
    spelling(Quantity::Rates, RATES, VECTOR),
    yielding(Quantity::Rates, RATES_OF_LOGS, VECTOR),
    yielding(Quantity::Rates, "xyz gyrorad angularvelocity", "00 01 02"),
    yielding(Quantity::Rates, "w omega", AXES_OF),
    yielding(Quantity::Rates, NONE, RATES_WITHOUT_STEM),
    spelling(Quantity::Momentum, MOMENTA, VECTOR),
    // letters alone are a quaternion, and three of them an angular velocity, where nothing else is
    yielding(Quantity::Quaternion, NONE, LETTERS),
    yielding(Quantity::Rates, NONE, AXES),
];

impl Spelling {
    /// What names begin with.
    pub(crate) fn stems(&self) -> impl Iterator<Item = &'static str> {
        self.stems.split_whitespace().map(|stem| if stem == NONE { "" } else { stem })
    }

    /// Sets of what they end with.
    pub(crate) fn components(&self) -> impl Iterator<Item = impl Iterator<Item = &'static str> + Clone> {
        self.components.split('|').map(str::split_whitespace)
    }
}

/// The axes that a stem states.
pub(crate) fn frame(stem: &str) -> Option<Frame> {
    match stem {
        s if s.ends_with("space") || s.ends_with("world") || s.ends_with("bnn") || s == "omegas" => {
            Some(Frame::Space)
        }
        s if s.ends_with("body")
            || s.ends_with("bnb")
            || s.contains("gyr")
            || ["wb", "omegab", "wrss"].contains(&s) =>
        {
            Some(Frame::Body)
        }
        _ => None,
    }
}

/// What an attitude takes where, as a stem states it.
pub(crate) fn direction(stem: &str) -> Option<Direction> {
    match stem {
        "qbodytospace" => Some(Direction::BodyToSpace),
        "qspacetobody" => Some(Direction::SpaceToBody),
        _ => None,
    }
}

/// Words of messages and topics: before a quantity they name no body.
const MESSAGES: &str = "field msg message data pose twist transform rigidbody imu stateestimate attitude orientation rotation \
    angular velocity velocities";

/// Words before a rate that is none of a motion, or not the one that was.
const NO_MOTION: &str = "acceleration accel acc bias offset error covariance variance std stddev sigma noise target setpoint \
    desired des command cmd reference ref";

/// Whether a word in lower case is one of messages.
pub(crate) fn is_of_message(word: &str) -> bool {
    MESSAGES.split_whitespace().any(|known| known == word)
}

/// Whether letters say that a quantity is an angular velocity.
pub(crate) fn says_rates(letters: &str) -> bool {
    let words = ["gyr", "angular", "angvel", "angrate", "omega", "rotationrate", "rollspeed", "rollrate"];
    words.iter().any(|word| letters.contains(word))
}

/// Whether the words before a quantity say that it is of no motion.
pub(crate) fn says_no_motion(owner: &str) -> bool {
    let lower = owner.to_lowercase();
    let mut words = lower.split(|c: char| !c.is_alphanumeric());
    words.any(|word| NO_MOTION.split_whitespace().any(|known| known == word))
}

/// Names of times in the order of preference, with the unit that a name implies. Words for time are those of the languages
/// that phyphox speaks.
const TIMES: &str = "secondselapsed:s gyrotimestampsincereboot:s motiontimestampsincereboot:s timestampsincereboot:s \
    timesincestartinms:ms t time timeboot zeit temps tiempo tempo tijd czas čas tid zaman χρόνος время 时间 時間 시간 \
    simtime timestamp elapsed elapsedtime timestartup timestampunix millis:ms micros:us sampletimefine timestampsample fieldheaderstamp epoc \
    epoch jd:d mjd:d loggingtime datetime date timestep";

/// Names of counters, which count samples and are times only with their rate.
const COUNTERS: &str = "packetcounter counter packetnumber packetcount samplecounter samplenumber frame";

/// Names of the bodies to which rows belong.
const IDS: &str = "id body bodyid bodyname name link entity object";

/// Units at the end of the letters of a name, and how they are written apart.
#[derive(Clone, Copy)]
pub(crate) struct Endings(&'static str);

pub(crate) const NO_ENDINGS: Endings = Endings("");
pub(crate) const TIME_ENDINGS: Endings =
    Endings("ms:ms us:us ns:ns nanos:ns sec:s s:s msec:ms usec:us nsec:ns");
pub(crate) const ANGLE_ENDINGS: Endings = Endings("deg:deg rad:rad");
pub(crate) const RATE_ENDINGS: Endings = Endings(
    "radpersec:rad/s radps:rad/s rads:rad/s degpersec:deg/s degps:deg/s degs:deg/s dps:deg/s rpm:rpm \
     radsec:rad/s degsec:deg/s",
);

impl Endings {
    /// The unit that `rest` ends a name with, and which of the endings that is.
    pub(crate) fn unit(self, rest: &str) -> Option<(usize, &'static str)> {
        let pairs = self.0.split_whitespace().filter_map(|pair| pair.split_once(':'));
        pairs.enumerate().find(|(_, (ending, _))| *ending == rest).map(|(k, (_, unit))| (k, unit))
    }
}

/// Names of times, and the unit that each implies.
pub(crate) fn times() -> impl Iterator<Item = (&'static str, Option<&'static str>)> {
    TIMES.split_whitespace().map(|word| match word.split_once(':') {
        Some((name, unit)) => (name, Some(unit)),
        None => (word, None),
    })
}

/// Which of the counters a name is.
pub(crate) fn counter(letters: &str) -> Option<usize> {
    COUNTERS.split_whitespace().position(|known| known == letters)
}

/// Whether a name is that of bodies.
pub(crate) fn is_id(letters: &str) -> bool {
    IDS.split_whitespace().any(|known| known == letters)
}
