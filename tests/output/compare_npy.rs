//! Tables in `.npy` files of other programs: orders, precisions, versions, names, and headers that lie.

use super::compare_finds::{compared, pair};

use bearing_dynamics::output::compare::tolerance::ToleranceClass;
use bearing_dynamics::output::compare::{Options, compare};
use bearing_dynamics::output::npy::{self, NpyError};
use bearing_dynamics::output::series::Series;
use ndarray::Array2;
use std::fs;

#[test]
fn a_header_that_promises_too_much_is_refused_without_allocating() {
    let root = tempfile::tempdir().unwrap();
    let path = root.path().join("huge.npy");
    let nested = "(".repeat(9000);
    for shape in [
        "(1000000000000, 8)",
        "(18446744073709551615, 8)",
        "(99999999999999999999, 8)",
        // No numbers at all, and a name for each column of them.
        "(0, 4611686018427387904)",
        "(0, 100000)",
        &nested,
    ] {
        let mut header = format!("{{'descr': '<f8', 'fortran_order': False, 'shape': {shape}, }}");
        while !(header.len() + 11).is_multiple_of(64) {
            header.push(' ');
        }
        header.push('\n');
        let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
        bytes.extend((header.len() as u16).to_le_bytes());
        bytes.extend(header.as_bytes());
        fs::write(&path, bytes).unwrap();
        assert!(compare(&path, &path, &Options::default()).is_err());
    }
    // A header of four gigabytes.
    for version in [2, 3] {
        let mut bytes = b"\x93NUMPY".to_vec();
        bytes.extend([version, 0, 255, 255, 255, 255]);
        bytes.extend(b"{'descr': '<f8', 'fortran_order': False, 'shape': (1, 1), }\n");
        fs::write(&path, bytes).unwrap();
        let error = compare(&path, &path, &Options::default()).unwrap_err().to_string();
        assert!(error.contains("header claims 4294967295 bytes"), "{error}");
    }
}

/// As NumPy's `save` has it: what it says of the table, blanks and a break up to a multiple of 64 bytes, then the numbers row by row.
#[test]
fn npy_is_written_as_numpy_writes_it() {
    let tables = [(2, 3), (7, 1), (0, 4), (123_456, 1)];
    for (rows, columns) in tables {
        // By columns in memory.
        let table = Array2::from_shape_fn((columns, rows), |(j, i)| i as f64 - 0.25 * j as f64);
        let file = npy::file(&table.reversed_axes());
        let says =
            format!("{{'descr': '<f8', 'fortran_order': False, 'shape': ({rows}, {columns}), }}");
        let mut header = [&b"\x93NUMPY\x01\0\x76\0"[..], says.as_bytes()].concat();
        header.resize(127, b' ');
        header.push(b'\n');
        assert!(file.starts_with(&header), "{rows} {columns}");
        let numbers =
            file[128..].chunks_exact(8).map(|b| f64::from_le_bytes(b.try_into().unwrap()));
        let expected =
            (0..rows).flat_map(|i| (0..columns).map(move |j| i as f64 - 0.25 * j as f64));
        assert!(numbers.eq(expected) && file.len() == 128 + 8 * rows * columns);
    }
}

/// Tables as NumPy writes them, to the byte but for the padding of the header.
#[test]
fn npy_is_read_in_both_orders_precisions_and_versions() {
    let root = tempfile::tempdir().unwrap();
    let path = root.path().join("t.npy");
    let file = |version: u8, header: &str, data: &[u8]| {
        let mut bytes = b"\x93NUMPY".to_vec();
        bytes.extend([version, 0]);
        match version {
            1 => bytes.extend((header.len() as u16).to_le_bytes()),
            _ => bytes.extend((header.len() as u32).to_le_bytes()),
        }
        bytes.extend(header.as_bytes());
        bytes.extend(data);
        fs::write(&path, bytes).unwrap();
        Series::read_npy(&path).map(|series| series.data().clone())
    };
    let rows: [f64; 6] = [1.5, -2.0, 0.25, 1e3, 7.0, -0.5];
    let columns = [rows[0], rows[3], rows[1], rows[4], rows[2], rows[5]];
    let expected = ndarray::arr2(&[[1.5, -2.0, 0.25], [1e3, 7.0, -0.5]]);
    let bytes = |values: &[f64], of: &dyn Fn(f64) -> Vec<u8>| -> Vec<u8> {
        values.iter().flat_map(|value| of(*value)).collect()
    };
    type Code = fn(f64) -> Vec<u8>;
    let codes: [(&str, Code); 4] = [
        ("<f8", |x| x.to_le_bytes().to_vec()),
        (">f8", |x| x.to_be_bytes().to_vec()),
        ("<f4", |x| (x as f32).to_le_bytes().to_vec()),
        (">f4", |x| (x as f32).to_be_bytes().to_vec()),
    ];
    for (descr, code) in codes {
        for version in [1, 2, 3] {
            for (order, values) in [("False", &rows), ("True", &columns)] {
                let header = format!(
                    "{{'descr': '{descr}', 'fortran_order': {order}, 'shape': (2, 3), }}    \n"
                );
                assert_eq!(file(version, &header, &bytes(values, &code)).unwrap(), expected);
                let cut = bytes(&values[..5], &code);
                assert!(file(version, &header, &cut).is_err(), "{header}");
            }
        }
    }
    let header = "{\"shape\":(6,),\"fortran_order\":False,\"descr\":\"<f8\"}";
    let column = file(1, header, &bytes(&rows, &codes[0].1)).unwrap();
    assert_eq!(column, ndarray::Array2::from_shape_vec((6, 1), rows.to_vec()).unwrap());
    for wrong in [
        "{'descr': '<i8', 'fortran_order': False, 'shape': (6,)}",
        "{'descr': [('a', '<f8')], 'fortran_order': False, 'shape': (6,)}",
        "{'descr': '<f8', 'fortran_order': False, 'shape': (1, 2, 3)}",
        "{'descr': '<f8', 'fortran_order': False, 'shape': ()}",
        "{'descr': '<f8', 'fortran_order': False, 'shape': (-6,)}",
        "{'descr': '<f8', 'fortran_order': False}",
        "{'descr': '<f8', 'descr': '<f8', 'fortran_order': False, 'shape': (6,)}",
        "{'descr': '<f8', 'fortran_order': No, 'shape': (6,)}",
        "{'descr': '<f8', 'fortran_order': False, 'shape': (6,)} more",
        "",
    ] {
        assert!(file(1, wrong, &bytes(&rows, &codes[0].1)).is_err(), "{wrong}");
    }
}

#[test]
fn npy_without_names_takes_those_of_the_reference() {
    let (_root, reference, candidate) = pair();
    fs::remove_file(candidate.join("series.columns.json")).unwrap();
    assert!(compared(&reference, &candidate, ToleranceClass::F64Exact).equal);
    let csv = reference.join("series.csv");
    let npy = candidate.join("series.npy");
    assert!(compared(&csv, &npy, ToleranceClass::F64Exact).equal);
    // f32, as a graphics processor would write it.
    let double = fs::read(&npy).unwrap();
    let header = 10 + usize::from(u16::from_le_bytes([double[8], double[9]]));
    let words = String::from_utf8_lossy(&double[10..header]).replace("<f8", "<f4");
    let numbers =
        double[header..].chunks_exact(8).map(|b| f64::from_le_bytes(b.try_into().unwrap()));
    let single = numbers.flat_map(|number| (number as f32).to_le_bytes());
    let single = [&double[..10], words.as_bytes(), &single.collect::<Vec<u8>>()].concat();
    fs::write(&npy, single).unwrap();
    assert!(compared(&csv, &npy, ToleranceClass::Mixed).equal);
    assert!(!compared(&csv, &npy, ToleranceClass::F64Reordered).equal);
}

/// Rows may be many, columns not.
#[test]
fn npy_has_more_room_for_rows_than_for_columns() {
    let file = |rows: usize, columns: usize| {
        let header =
            format!("{{'descr': '<f8', 'fortran_order': False, 'shape': ({rows}, {columns}), }}\n");
        let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
        bytes.extend((header.len() as u16).to_le_bytes());
        bytes.extend(header.as_bytes());
        bytes.extend(std::iter::repeat_n(0u8, 8 * rows * columns));
        npy::parse(&bytes)
    };
    let most = npy::MOST_COLUMNS;
    assert_eq!(file(most + 1, 2).unwrap().dim(), (most + 1, 2));
    assert_eq!(file(2, most).unwrap().dim(), (2, most));
    assert!(matches!(file(2, most + 1), Err(NpyError::Columns { columns }) if columns == most + 1));
}
