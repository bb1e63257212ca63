//! The records that are read, field by field as the MCAP specification has them.
//!
//! | record | fields |
//! |---|---|
//! | schema | u16 id, text name, text encoding, (data) |
//! | channel | u16 id, u16 schema (0 none), text topic, text encoding, (metadata) |
//! | message | u16 channel, (u32 sequence), u64 log time, (u64 publish time), body |
//! | chunk | (u64 first and u64 last log time), u64 unpacked size, u32 checksum of the unpacked bytes (0 none), text compression, u64 size, packed bytes |
//! | data end | u32 checksum of all bytes before the record (0 none) |
//! | statistics | u64 messages, (…) |
//! | footer | (u64 start of the summary, u64 of its offsets), u32 checksum (0 none) |
//!
//! Fields in brackets are stepped over.

use crate::fields::{BadField, Fields};

pub(crate) struct Schema<'a> {
    pub(crate) id: u16,
    pub(crate) name: &'a str,
}

pub(crate) struct ChannelRecord<'a> {
    pub(crate) id: u16,
    pub(crate) schema: u16,
    pub(crate) topic: &'a str,
    pub(crate) encoding: &'a str,
}

pub(crate) struct MessageRecord<'a> {
    pub(crate) channel: u16,
    pub(crate) log_time: u64,
    pub(crate) body: &'a [u8],
}

pub(crate) struct ChunkRecord<'a> {
    pub(crate) unpacked_size: u64,
    pub(crate) checksum: u32,
    pub(crate) compression: &'a str,
    pub(crate) packed: &'a [u8],
}

pub(crate) fn schema(body: &[u8]) -> Result<Schema<'_>, BadField> {
    let mut fields = Fields::new(body);
    Ok(Schema {
        id: fields.u16("id")?,
        name: fields.text("name")?,
    })
}

pub(crate) fn channel(body: &[u8]) -> Result<ChannelRecord<'_>, BadField> {
    let mut fields = Fields::new(body);
    Ok(ChannelRecord {
        id: fields.u16("id")?,
        schema: fields.u16("schema")?,
        topic: fields.text("topic")?,
        encoding: fields.text("message encoding")?,
    })
}

pub(crate) fn message(body: &[u8]) -> Result<MessageRecord<'_>, BadField> {
    let mut fields = Fields::new(body);
    let channel = fields.u16("channel")?;
    fields.u32("sequence")?;
    let log_time = fields.u64("log time")?;
    fields.u64("publish time")?;
    Ok(MessageRecord {
        channel,
        log_time,
        body: fields.rest(),
    })
}

pub(crate) fn chunk(body: &[u8]) -> Result<ChunkRecord<'_>, BadField> {
    let mut fields = Fields::new(body);
    fields.u64("first log time")?;
    fields.u64("last log time")?;
    let unpacked_size = fields.u64("unpacked size")?;
    let checksum = fields.u32("checksum")?;
    let compression = fields.text("compression")?;
    let packed_size = fields.u64("size")?;
    Ok(ChunkRecord {
        unpacked_size,
        checksum,
        compression,
        packed: fields.bytes("content", packed_size)?,
    })
}

pub(crate) fn data_checksum(body: &[u8]) -> Result<u32, BadField> {
    Fields::new(body).u32("checksum")
}

pub(crate) fn message_count(body: &[u8]) -> Result<u64, BadField> {
    Fields::new(body).u64("message count")
}

pub(crate) fn summary_checksum(body: &[u8]) -> Result<u32, BadField> {
    let mut fields = Fields::new(body);
    fields.u64("start of the summary")?;
    fields.u64("start of the offsets")?;
    fields.u32("checksum")
}
