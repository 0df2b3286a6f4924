use super::*;
use crate::Error;
use std::io::{self, Cursor, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

/// Memory that is full after some bytes.
#[derive(Clone, Debug, Default)]
struct Disk {
    bytes: Cursor<Vec<u8>>,
    room: u64,
}

impl Disk {
    fn of(bytes: &[u8], room: u64) -> Self {
        Self { bytes: Cursor::new(bytes.to_vec()), room }
    }
}

impl Read for Disk {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        self.bytes.read(buffer)
    }
}

impl Seek for Disk {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        self.bytes.seek(to)
    }
}

impl Write for Disk {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let free = usize::try_from(self.room.saturating_sub(self.bytes.position())).unwrap();
        if free == 0 && !bytes.is_empty() {
            return Err(io::ErrorKind::StorageFull.into());
        }
        self.bytes.write(&bytes[..bytes.len().min(free)])
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

impl Store for Disk {
    fn cut(&mut self, length: u64) -> io::Result<()> {
        self.bytes.get_mut().truncate(usize::try_from(length).unwrap());
        Ok(())
    }

    fn sync(&mut self) -> io::Result<()> {
        Ok(())
    }
}

fn header(shard: &str) -> Header {
    Header {
        seed: u64::MAX,
        samples: 9,
        shard: shard.parse().unwrap(),
        character: "00ff".to_owned(),
        setting: serde_json::json!({"cage": {"voxel": 0.05}, "b": 1}),
        arrays: vec![
            ArrayInfo::new("pose", &[3], "rad"),
            ArrayInfo::new("displacement", &[0, 2], "m"),
            ArrayInfo::new("energy", &[], "J"),
        ],
    }
}

/// The arrays of sample `i`: pure functions of it.
fn arrays(i: u64) -> [Vec<f32>; 3] {
    let x = f32::from(u16::try_from(i).unwrap());
    [vec![x, -x, 0.5], vec![x; 2 * usize::try_from(i % 4).unwrap()], vec![100.0 + x]]
}

fn append<S: Store>(writer: &mut Writer<S>, i: u64) -> Result<(), Error> {
    let values = arrays(i);
    let names = ["pose", "displacement", "energy"];
    let named: Vec<_> = names.iter().zip(&values).map(|(name, values)| Array { name, values }).collect();
    writer.append(i, &named)
}

fn open(bytes: &[u8], shard: &str) -> Result<Writer<Disk>, Error> {
    Writer::resume(Path::new("a.set"), Disk::of(bytes, u64::MAX), &header(shard))
}

/// The bytes of a shard with all its samples.
fn whole(shard: &str) -> Vec<u8> {
    let mut disk = Disk::of(&[], u64::MAX);
    finish(&mut disk, shard).unwrap();
    disk.bytes.into_inner()
}

/// What a run does: opens, writes what is missing; the disk survives it.
fn finish(disk: &mut Disk, shard: &str) -> Result<Resumed, Error> {
    let mut writer = Writer::resume(Path::new("a.set"), Lent(disk), &header(shard))?;
    for i in header(shard).shard.indices(9) {
        if !writer.has(i) {
            append(&mut writer, i)?;
        }
    }
    Ok(writer.resumed())
}

/// A store that stays when its writer is gone.
struct Lent<'a>(&'a mut Disk);

impl Read for Lent<'_> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        self.0.read(buffer)
    }
}

impl Seek for Lent<'_> {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        self.0.seek(to)
    }
}

impl Write for Lent<'_> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.0.flush()
    }
}

impl Store for Lent<'_> {
    fn cut(&mut self, length: u64) -> io::Result<()> {
        self.0.cut(length)
    }

    fn sync(&mut self) -> io::Result<()> {
        self.0.sync()
    }
}

fn reader(files: &[&[u8]]) -> Result<Reader<Cursor<Vec<u8>>>, Error> {
    let named = (0..).zip(files).map(|(i, b)| (PathBuf::from(format!("{i}.set")), Cursor::new(b.to_vec())));
    Reader::over(named.collect())
}

#[test]
fn shards_are_read_as_one_dataset() {
    let (a, b, c) = (whole("0/3"), whole("1/3"), whole("2/3"));
    let mut all = reader(&[&c, &a, &b]).unwrap();
    assert_eq!((all.len(), all.missing(), all.torn().len()), (9, vec![], 0));
    for i in 0..9 {
        assert_eq!(all.sample(i).unwrap(), Sample { index: i, arrays: arrays(i).to_vec() });
    }
    assert_eq!(all.header(), &header("0/1"));
    let mut some = reader(&[&c, &b]).unwrap();
    assert_eq!(some.missing(), [0..1, 3..4, 6..7]);
    let text = some.sample(3).unwrap_err().to_string();
    assert!(text.contains("sample 3: it is in none of the files"), "{text}");
}

#[test]
fn files_that_do_not_go_together_are_refused() {
    let text = reader(&[&whole("0/3"), &whole("0/3")]).unwrap_err().to_string();
    assert!(text.contains("1.set: byte") && text.contains("sample 0: it is there twice"), "{text}");
    assert!(reader(&[]).unwrap_err().to_string().contains("there are none"));
    for (entry, change) in [
        ("seed", (|h| h.seed = 2) as fn(&mut Header)),
        ("samples", |h| h.samples = 10),
        ("character", |h| h.character = "01".to_owned()),
        ("setting", |h| h.setting["b"] = 2.into()),
        ("arrays", |h| h.arrays[0].unit = "m".to_owned()),
        ("shard", |h| h.shard = "1/3".parse().unwrap()),
    ] {
        let mut other = header("0/3");
        change(&mut other);
        let resumed = Writer::resume(Path::new("a.set"), Disk::of(&whole("0/3"), u64::MAX), &other);
        let text = resumed.unwrap_err().to_string();
        assert!(text.starts_with("a.set: header: ") && text.contains(entry), "{text}");
        if entry != "shard" {
            let mut disk = Disk::of(&[], u64::MAX);
            Writer::resume(Path::new("b"), Lent(&mut disk), &other).unwrap();
            let text = reader(&[&whole("0/3"), disk.bytes.get_ref()]).unwrap_err().to_string();
            assert!(text.contains(&format!("1.set: header: its `{entry}`")), "{text}");
        }
    }
}

/// Wherever a run is cut off, the next one keeps every whole sample, and the file ends up the same.
#[test]
fn every_cut_is_made_good() {
    let whole = whole("1/2");
    for end in 0..=whole.len() {
        let mut disk = Disk::of(&whole[..end], u64::MAX);
        let kept = reader(&[&whole[..end]]).map_or(0, |r| r.len());
        let resumed = finish(&mut disk, "1/2").unwrap_or_else(|e| panic!("{end}: {e}"));
        assert_eq!(resumed.kept, kept, "{end}");
        assert!(disk.bytes.get_ref() == &whole, "cut at {end}");
    }
}

/// A disk that is full at any byte costs the sample in work, no other; with room again the run goes on.
#[test]
fn a_full_disk_takes_only_the_sample_in_work() {
    let whole = whole("0/2");
    for room in 0..whole.len() {
        let mut disk = Disk::of(&[], room as u64);
        let text = finish(&mut disk, "0/2").expect_err("no room").to_string();
        assert!(text.contains("a.set: cannot be written"), "{text}");
        let left = disk.bytes.get_ref().clone();
        assert!(whole.starts_with(&left), "{room}: what is there is whole");
        let kept = reader(&[&whole[..room]]).map_or(0, |r| r.len());
        disk.room = u64::MAX;
        let resumed = finish(&mut disk, "0/2").unwrap();
        assert_eq!(resumed, Resumed { kept, cut: 0 }, "{room}");
        assert!(disk.bytes.get_ref() == &whole, "{room}");
    }
}

/// The same writer goes on after an error, without a new run.
#[test]
fn a_writer_goes_on_when_there_is_room_again() {
    let mut disk = Disk::of(&[], u64::MAX);
    let mut writer = Writer::resume(Path::new("a.set"), Lent(&mut disk), &header("0/1")).unwrap();
    append(&mut writer, 3).unwrap();
    writer.store_mut().0.room = writer.store_mut().0.bytes.get_ref().len() as u64 + 20;
    assert!(append(&mut writer, 1).is_err() && !writer.has(1) && writer.len() == 1);
    writer.store_mut().0.room = u64::MAX;
    append(&mut writer, 1).unwrap();
    append(&mut writer, 2).unwrap();
    let mut all = reader(&[disk.bytes.get_ref()]).unwrap();
    assert_eq!(all.indices().collect::<Vec<_>>(), [1, 2, 3]);
    assert_eq!(all.sample(1).unwrap().arrays, arrays(1));
}

#[test]
fn samples_that_do_not_fit_are_refused() {
    let mut writer = open(&whole("0/2")[..], "0/2").unwrap();
    assert_eq!(writer.len(), 5);
    let mut refused = |i, named: &[Array<'_>], problem: &str| {
        let text = writer.append(i, named).expect_err(problem).to_string();
        assert!(text.contains(problem) && text.contains(&format!("sample {i}")), "{text}");
    };
    refused(4, &[], "it is there already");
    refused(1, &[], "it is not in shard 0/2 of 9 samples");
    refused(10, &[], "it is not in shard 0/2 of 9 samples");
    let mut writer = open(&[], "0/1").unwrap();
    let mut refused = |pose: &[f32], rows: &[f32], last: &str, problem: &str| {
        let named = [("pose", pose), ("displacement", rows), (last, &[1.0])];
        let named = named.map(|(name, values)| Array { name, values });
        let text = writer.append(0, &named).expect_err(problem).to_string();
        assert!(text.contains(problem), "{text}");
    };
    refused(&[0.0; 3], &[], "force", "its arrays are pose, displacement, force; the header's pose,");
    refused(&[0.0; 4], &[], "energy", "array pose: it has 4 floats, its shape is [3]");
    refused(&[0.0; 3], &[0.0; 3], "energy", "array displacement: it has 3 floats, its shape is [0, 2]");
    refused(&[0.0, f32::NAN, 0.0], &[], "energy", "array pose: number 1 is NaN");
    assert!(writer.is_empty());
}

#[test]
fn impossible_headers_are_refused() {
    let refused = |change: fn(&mut Header), problem: &str| {
        let mut header = header("0/1");
        change(&mut header);
        let resumed = Writer::resume(Path::new("a.set"), Disk::of(&[], u64::MAX), &header);
        let text = resumed.expect_err(problem).to_string();
        assert!(text.contains(problem), "{text}");
    };
    refused(|h| h.arrays.clear(), "arrays: none");
    refused(|h| h.arrays[1].name = "pose".to_owned(), "array 1: it has no name of its own");
    refused(|h| h.arrays[1].shape = vec![3, 0], "array 1: its shape is impossible");
    refused(|h| h.arrays[1].shape = vec![u64::MAX, 3], "array 1: its shape is impossible");
    refused(|h| h.setting = "x".repeat(1 << 20).into(), "longer than a MiB");
}

/// Bytes that no writer leaves: an error or a dataset, never a panic, and never a wrong number.
#[test]
fn damage_is_found_wherever_it_is() {
    let whole = whole("0/1");
    let mut refused = 0;
    for at in 0..whole.len() {
        for bit in [0, 3, 7] {
            let mut bytes = whole.clone();
            bytes[at] ^= 1 << bit;
            let Ok(mut found) = reader(&[&bytes]) else {
                refused += 1;
                continue;
            };
            for i in 0..9 {
                if let Ok(sample) = found.sample(i) {
                    assert_eq!(sample.arrays, arrays(i), "byte {at} bit {bit}");
                }
            }
            let lost = (0..9).filter(|i| found.sample(*i).is_err()).count();
            assert!(lost > 0 || found.torn().len() == 1, "byte {at} bit {bit} was not seen");
            // A writer must not cut off good samples because of a bad one before them.
            match open(&bytes, "0/1") {
                Ok(writer) => assert_eq!(writer.len(), 8, "byte {at} bit {bit}"),
                Err(error) => assert!(error.to_string().contains("damaged"), "{error}"),
            }
        }
    }
    assert!(refused > 0, "heads were damaged too");
}

#[test]
fn promises_of_a_head_take_no_memory() {
    let mut bytes = whole("0/1");
    bytes[12..16].copy_from_slice(&u32::MAX.to_le_bytes());
    assert!(reader(&[&bytes]).unwrap_err().to_string().contains("byte 12: it is cut off"));
    bytes[8] = 2;
    assert!(reader(&[&bytes]).unwrap_err().to_string().contains("version 2 is not known here"));
    assert!(reader(&[b"PNG"]).unwrap_err().to_string().contains("this is no dataset"));
    assert!(open(b"something else", "0/1").unwrap_err().to_string().contains("this is no dataset"));
}
