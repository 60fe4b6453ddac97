//! Numbers in JSON bit for bit: finite ones as numbers, which serde_json writes in the digits that
//! read back to the same bits; the others as their bits, since JSON has no word for them.

use serde::{Deserialize, Deserializer, Serializer, de::Error};

#[derive(Deserialize)]
#[serde(untagged)]
enum Written {
    Number(f64),
    Bits(String),
}

pub fn serialize<S: Serializer>(value: &f64, serializer: S) -> Result<S::Ok, S::Error> {
    match value.is_finite() {
        true => serializer.serialize_f64(*value),
        false => serializer.serialize_str(&format!("{:016x}", value.to_bits())),
    }
}

pub fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<f64, D::Error> {
    match Written::deserialize(deserializer)? {
        Written::Number(value) => Ok(value),
        Written::Bits(text) => {
            let value = u64::from_str_radix(&text, 16).map(f64::from_bits);
            match value.map_err(D::Error::custom)? {
                finite if finite.is_finite() => Err(D::Error::custom("a number as text")),
                other => Ok(other),
            }
        }
    }
}
