//! One body as many input decks and Gmsh files, as programs and people write them.
#![allow(dead_code)]

use std::fmt::Write;

/// mm; two cubes along X.
pub const NODES: [[i32; 3]; 12] = [
    [0, 10, 10],
    [0, 10, 0],
    [0, 0, 10],
    [0, 0, 0],
    [10, 10, 10],
    [10, 10, 0],
    [10, 0, 10],
    [10, 0, 0],
    [20, 10, 10],
    [20, 10, 0],
    [20, 0, 10],
    [20, 0, 0],
];

/// Numbers of nodes, from 1.
pub const TETS: [[usize; 4]; 12] = [
    [4, 2, 1, 5],
    [4, 3, 5, 1],
    [4, 6, 2, 5],
    [4, 3, 7, 5],
    [4, 8, 6, 5],
    [4, 8, 5, 7],
    [8, 6, 5, 9],
    [8, 7, 9, 5],
    [8, 10, 6, 9],
    [8, 7, 11, 9],
    [8, 12, 10, 9],
    [8, 12, 9, 11],
];

/// A file that describes the body with the node sets at x = 0 and x = 20 and the surface at x = 20.
pub struct Variant {
    pub name: String,
    pub bytes: Vec<u8>,
    /// Names of the three sets.
    pub sets: [&'static str; 3],
    /// The file has a node without elements.
    pub stray: bool,
}

const PLAIN: [&str; 3] = ["fix", "tip", "end"];

/// A way to write a coordinate of a node.
type Number = fn(i32) -> String;

const NUMBERS: [(&str, Number); 9] = [
    ("whole", |x| x.to_string()),
    ("point", |x| format!("{x}.")),
    ("exponent", |x| format!("{:.3}E+01", f64::from(x) / 10.0)),
    ("double", |x| format!("{}.D0", x)),
    ("double, small", |x| format!("{:.1}d+01", f64::from(x) / 10.0)),
    ("exponent without a letter", |x| format!("{:.1}+1", f64::from(x) / 10.0)),
    ("negative exponent without a letter", |x| format!("{}.-1", x * 10)),
    ("blank zeros", |x| if x == 0 { String::new() } else { format!("{x}.0") }),
    ("zeros left out", |x| if x == 0 { String::new() } else { x.to_string() }),
];

fn nodes((what, number): (&str, Number)) -> String {
    let mut text = "*NODE\n".to_string();
    for (index, place) in NODES.iter().enumerate() {
        let mut line = format!("{}, {}", index + 1, place.map(number).join(", "));
        if what == "zeros left out" {
            line.truncate(line.trim_end_matches([',', ' ']).len());
        }
        text += &format!("{line}\n");
    }
    text
}

fn elements(kind: &str) -> String {
    let mut text = format!("*ELEMENT, TYPE={kind}, ELSET=all\n");
    for (index, tet) in TETS.iter().enumerate() {
        let _ = writeln!(text, "{}, {}", index + 1, tet.map(|node| node.to_string()).join(", "));
    }
    text
}

const SETS: &str = "*NSET, NSET=fix\n1, 2, 3, 4\n*NSET, NSET=tip\n9, 10, 11, 12\n";
const END: &str = "*ELSET, ELSET=last\n11, 12\n*SURFACE, NAME=end, TYPE=ELEMENT\nlast, S3\n";

/// Where a deck has its mesh and sets.
const BODIES: [&str; 7] = [
    "flat",
    "sets in the part",
    "sets in the assembly",
    "sets of the part in the assembly",
    "independent instance",
    "one name in part and assembly",
    "reference point",
];

fn body(kind: &str, mesh: &str) -> (String, [&'static str; 3]) {
    let in_part = ["p-1.fix", "p-1.tip", "p-1.end"];
    let assembly = |part: &str, instance: &str, rest: &str| {
        format!(
            "*PART, NAME=p\n{part}*END PART\n*ASSEMBLY, NAME=a\n*INSTANCE, NAME=p-1, PART=p\n{instance}\
             *END INSTANCE\n{rest}*END ASSEMBLY\n"
        )
    };
    let of_instance = format!("{SETS}{END}")
        .replace("SET=fix", "SET=fix, INSTANCE=p-1")
        .replace("SET=tip", "SET=tip, INSTANCE=P-1")
        .replace("SET=last", "SET=last, INSTANCE=p-1");
    match kind {
        "flat" => (format!("{mesh}{SETS}{END}"), PLAIN),
        "sets in the part" => (
            assembly(&format!("{mesh}{SETS}{END}"), "0., 0., 0.\n0., 0., 0., 0., 0., 1., 0.\n", ""),
            in_part,
        ),
        "sets in the assembly" => (assembly(mesh, "0, 0, 0\n", &of_instance), PLAIN),
        "sets of the part in the assembly" => {
            let named = "*NSET, NSET=fix\np-1.fix\n*NSET, NSET=tip, INSTANCE=p-1\ntip\n*SURFACE, NAME=end\nP-1.last, S3\n";
            (assembly(&format!("{mesh}{SETS}{END}"), "", named), PLAIN)
        }
        "independent instance" => (assembly("", &format!("{mesh}{SETS}{END}"), ""), in_part),
        "one name in part and assembly" => {
            let others = "*NSET, NSET=fix, GENERATE\n1, 12, 1\n*NSET, NSET=TIP\n1, 5\n*ELSET, ELSET=last, GENERATE\n1, 12\n\
                          *SURFACE, NAME=end\nlast\n";
            (assembly(&format!("{mesh}{others}"), "", &of_instance), PLAIN)
        }
        _ => {
            let point = "*NODE\n1, 40., 5., 5.\n*ELEMENT, TYPE=MASS, ELSET=last\n1, 1\n*NSET, NSET=point\n1\n\
                         *NSET, NSET=\"end point\"\n1,\n";
            let of_instance = of_instance.replace("=last", "=these").replace("last,", "these,");
            (assembly(mesh, "", &format!("{point}{of_instance}")), PLAIN)
        }
    }
}

/// Starts of a deck and line ends.
const STARTS: [(&str, &str, &str); 5] = [
    ("nothing", "", "\n"),
    ("heading", "*Heading\n a bar, 20 x 10 x 10\n", "\n"),
    ("comments", "** a comment\n**NODE\n\n", "\n"),
    ("byte order mark", "\u{feff}", "\n"),
    ("line ends of Windows", "*HEADING\nbar\n", "\r\n"),
];

/// Definitions of the three sets in a flat deck. A `<` stands for the mesh, which comes first without it.
const SET_FORMS: [(&str, &str); 15] = [
    (
        "GENERATE",
        "*NSET, NSET=fix, GENERATE\n1, 4\n*NSET, NSET=tip, GENERATE\n9, 12, 1\n*ELSET, ELSET=last, GENERATE\n11, 12, 1\n*SURFACE, NAME=end\nlast, S3\n",
    ),
    (
        "before the mesh",
        "*SURFACE, NAME=end\nlast, S3\n*ELSET, ELSET=last\n11, 12\n*NSET, NSET=fix\n1, 2, 3, 4\n*NSET, NSET=tip\n9, 10, 11, 12\n<",
    ),
    (
        "used before they are defined",
        "*NSET, NSET=fix\nmore, 1\n*NSET, NSET=tip\n9, 10, last two\n*NSET, NSET=more\n2, 3, 4\n*NSET, NSET=last two\n11, 12\n*SURFACE, NAME=end\nlast, S3\n*ELSET, ELSET=last\n11, 12\n",
    ),
    (
        "case of definitions",
        "*NSET, NSET=Fix\n1, 2, 3\n*Nset, nset=FIX\n4\n*nset, nset=TIP\n9, 10\n*NSET, NSET=tip\n11, 12\n*ELSET, ELSET=Last\n11, 12\n*SURFACE, NAME=end\nlast, S3\n",
    ),
    (
        "case of keywords",
        "*nset, nset=fix\n1, 2, 3, 4\n*Nset, Nset=tip\n9, 10, 11, 12\n*elset, Elset=last\n11, 12\n*surface, type=Element, name=end\nLAST, s3\n",
    ),
    (
        "quotes",
        "*NSET, NSET=\"fix\"\n1, 2, 3, 4\n*NSET, NSET=\"last, but one\"\n9, 10\n*NSET, NSET=tip\n\"last, but one\", 11, 12\n*ELSET, ELSET=\"end faces\"\n11, 12\n*SURFACE, NAME=end, TYPE=ELEMENT\n\"end faces\", S3\n",
    ),
    (
        "beyond the mesh",
        "*NSET, NSET=fix\n1, 2, 3, 4, 99\n*NSET, NSET=tip, GENERATE\n9, 5000\n*ELSET, ELSET=last\n11, 12, 13\n*SURFACE, NAME=end\nlast, S3\n",
    ),
    (
        "nodes of elements",
        "*ELEMENT, TYPE=S3, ELSET=skin\n101, 4, 2, 1\n102, 4, 3, 1\n*NSET, NSET=fix, ELSET=skin\n*ELEMENT, TYPE=M3D3, ELSET=skin 2\n103, 12, 10, 9\n104, 12, 9, 11\n*NSET, ELSET=skin 2, NSET=tip\n*SURFACE, NAME=end\nskin 2, SPOS\n",
    ),
    (
        "triangles",
        "*ELEMENT, TYPE=R3D3, ELSET=end\n103, 12, 10, 9\n104, 12, 9, 11\n*ELEMENT, TYPE=S3R, ELSET=fix\n101, 4, 2, 1\n102, 4, 3, 1\n*NSET, NSET=tip\n9, 10, 11, 12\n",
    ),
    (
        "lines",
        "*ELEMENT, TYPE=T3D2, ELSET=fix\n101, 1, 2\n102, 3, 4\n*ELEMENT, TYPE=B31, ELSET=tip\n103, 9, 10\n104, 11, 12\n*ELSET, ELSET=last\n11, 12\n*SURFACE, NAME=end\nlast, S3\n",
    ),
    (
        "surface of nodes",
        "*NSET, NSET=first\n1, 2\n*SURFACE, NAME=fix, TYPE=NODE\nfirst, 1.\n3,\n4\n*NSET, NSET=tip\n9, 10, 11, 12\n*SURFACE, NAME=end\n11, S3\n12, S3\n",
    ),
    (
        "two surfaces of one name",
        "*NSET, NSET=fix\n1, 2, 3, 4\n*SURFACE, NAME=fix, TYPE=NODE\nfix\n*NSET, NSET=tip\n9, 10, 11, 12\n*SURFACE, NAME=end\n11, S3\n*SURFACE, NAME=END\n12, S3\n",
    ),
    (
        "blanks and commas",
        "*NSET, NSET=fix\n1, , 2\n\n** a comment\n3, 4,\n*NSET,\nNSET = tip\n 9,10 ,11\n12,,\n*ELSET , ELSET =last\n11\n12\n*SURFACE, NAME=end,\nTYPE=ELEMENT\nlast , S3,\n",
    ),
    (
        "itself",
        "*NSET, NSET=fix\n1, 2\n*NSET, NSET=fix\nfix, 3, 4\n*NSET, NSET=tip\n9, 10, 11, 12\n*SURFACE, NAME=end\n11, S3\n12, S3\n",
    ),
    (
        "parameters that mean nothing here",
        "*NSET, NSET=fix, INTERNAL, UNSORTED\n1, 2, 3, 4\n*NSET, INTERNAL, NSET=tip\n9, 10, 11, 12\n*ELSET, ELSET=last, INTERNAL\n11, 12\n*SURFACE, TYPE=ELEMENT, NAME=end, INTERNAL\nlast, S3\n",
    ),
];

/// Further content of a deck.
const FURTHER: [(&str, &str); 24] = [
    ("mass", "*ELEMENT, TYPE=MASS, ELSET=m\n100, 5\n*MASS, ELSET=m\n0.01\n"),
    ("rotary inertia", "*ELEMENT, TYPE=ROTARYI, ELSET=i\n100, 5\n"),
    ("spring", "*ELEMENT, TYPE=SPRINGA, ELSET=k\n100, 1, 5\n*SPRING, ELSET=k\n\n10.\n"),
    ("spring to the ground", "*ELEMENT, TYPE=SPRING1, ELSET=k\n100, 5\n*SPRING, ELSET=k\n2\n10.\n"),
    ("damper", "*ELEMENT, TYPE=DASHPOTA, ELSET=d\n100, 1, 5\n"),
    (
        "distributing coupling",
        "*ELEMENT, TYPE=DCOUP3D, ELSET=c\n100, 5\n*DISTRIBUTING COUPLING, ELSET=c\n1, 1.\n2, 1.\n",
    ),
    ("gap", "*ELEMENT, TYPE=GAPUNI, ELSET=g\n100, 1, 5\n*GAP, ELSET=g\n0.1\n"),
    ("connector", "*ELEMENT, TYPE=CONN3D2, ELSET=c\n100, 1, 5\n"),
    ("rigid triangles", "*ELEMENT, TYPE=R3D3, ELSET=skin\n101, 1, 2, 4\n102, 1, 4, 3\n"),
    ("rigid triangles within", "*ELEMENT, TYPE=R3D3, ELSET=skin\n101, 1, 2, 12\n"),
    ("rigid quadrangles", "*ELEMENT, TYPE=R3D4, ELSET=skin\n101, 1, 2, 4, 3\n"),
    ("shells", "*ELEMENT, TYPE=S4R, ELSET=skin\n101, 1, 2,\n4, 3\n*ELSET, ELSET=both\n101, 1\n"),
    ("pipe", "*ELEMENT, TYPE=PIPE31, ELSET=pipe\n101, 1, 2\n"),
    (
        "element of a user",
        "*USER ELEMENT, TYPE=U1, NODES=2\n*ELEMENT, TYPE=U1, ELSET=u\n101, 1, 2\n",
    ),
    ("coupling", "*COUPLING, CONSTRAINT NAME=c, REF NODE=5, SURFACE=end\n*KINEMATIC\n"),
    (
        "rigid body",
        "*RIGID BODY, NSET=tip, REF NODE=5\n*EQUATION\n2\n1, 1, 1., 2, 1, -1.\n*MPC\nBEAM, 1, 2\n",
    ),
    (
        "tie of surfaces of nodes",
        "*SURFACE, NAME=slave, TYPE=NODE\ntip, 1.\n*TIE, NAME=t\nslave, end\n",
    ),
    ("cutting surface", "*SURFACE, NAME=cut, TYPE=CUTTING SURFACE\n0., 0., 0., 1., 0., 0.\n"),
    ("analytical surface", "*SURFACE, TYPE=CYLINDER, NAME=tool\nSTART, 0., 0.\nLINE, 1., 0.\n"),
    ("combined surface", "*SURFACE, NAME=all faces, COMBINE=UNION\nend, end\n"),
    (
        "unknown set",
        "*NSET, NSET=lost\nno such set\n*SURFACE, NAME=s\nno such set, S1\n*SURFACE, NAME=s5\n1, S5\n",
    ),
    (
        "sets of nothing",
        "*NSET, NSET=none\n*ELSET, ELSET=none\n99, 98\n*NSET, NSET=odd, GENERATE\n5, 1\n",
    ),
    (
        "loads and steps",
        "*AMPLITUDE, NAME=ramp\n0., 0., 1., 1.\n*BOUNDARY\nfix, 1, 3\n*STEP\n*STATIC\n*CLOAD\ntip, 3, -25.\n*NODE PRINT, NSET=tip\nU\n*END STEP\n",
    ),
    (
        "section and orientation",
        "*ORIENTATION, NAME=o\n1., 0., 0., 0., 1., 0.\n*SOLID SECTION, ELSET=all, MATERIAL=steel, ORIENTATION=o\n,\n",
    ),
];

const KINDS: [&str; 5] = ["C3D4", "c3d4", "C3D4H", "C3D4T", "DC3D4"];

/// Input decks; the first is the plain one.
pub fn decks() -> Vec<Variant> {
    let mut all = Vec::new();
    let mut add = |name: String, text: String, sets: [&'static str; 3], stray: bool| {
        all.push(Variant { name, bytes: text.into_bytes(), sets, stray });
    };
    for number in NUMBERS {
        for kind in BODIES {
            for (start, head, line_end) in STARTS {
                let (text, sets) = body(kind, &(nodes(number) + &elements("C3D4")));
                let name = format!("numbers: {}; {kind}; start: {start}", number.0);
                add(name, format!("{head}{text}").replace('\n', line_end), sets, false);
            }
        }
    }
    let mesh = nodes(NUMBERS[1]) + &elements("C3D4");
    for (name, sets) in SET_FORMS {
        let text = match sets.strip_suffix('<') {
            Some(sets) => format!("{sets}{mesh}"),
            None => format!("{mesh}{sets}"),
        };
        add(format!("sets: {name}"), text, PLAIN, false);
    }
    for (name, further) in FURTHER {
        add(format!("further: {name}"), format!("{mesh}{SETS}{END}{further}"), PLAIN, false);
        add(format!("before: {name}"), format!("{mesh}{further}{SETS}{END}"), PLAIN, false);
    }
    for kind in KINDS {
        let mesh = nodes(NUMBERS[0]) + &elements(kind);
        add(format!("elements: {kind}"), format!("{mesh}{SETS}{END}"), PLAIN, false);
    }
    let stray = mesh.replacen("*ELEMENT", "13, 40, 5, 5\n*ELEMENT", 1);
    let text = format!("{stray}{SETS}{END}*NSET, NSET=point\n13\n");
    add("reference node without elements".into(), text, PLAIN, true);
    all
}

/// `$Elements` of version 2: points, triangles at both ends, tetrahedra.
fn elements_2(further: &[&str], sign: &str) -> String {
    let mut lines = vec![
        format!("2 2 {sign}1 5 4 2 1"),
        format!("2 2 {sign}1 5 4 3 1"),
        "2 2 2 6 12 10 9".to_string(),
        "2 2 2 6 12 9 11".to_string(),
        "2 2 4 7 12 10 9".to_string(),
        "2 2 4 7 12 9 11".to_string(),
    ];
    lines.extend(further.iter().map(ToString::to_string));
    lines.extend(TETS.iter().map(|t| format!("4 2 3 1 {} {} {} {}", t[0], t[1], t[2], t[3])));
    let mut text = format!("$Elements\n{}\n", lines.len());
    for (index, line) in lines.iter().enumerate() {
        let _ = writeln!(text, "{} {line}", index + 1);
    }
    text + "$EndElements\n"
}

fn nodes_2(parametric: bool, stray: bool) -> String {
    let name = if parametric { "ParametricNodes" } else { "Nodes" };
    let mut text = format!("${name}\n{}\n", 12 + usize::from(stray));
    let extra = [[50, 5, 5]];
    for (index, [x, y, z]) in NODES.iter().chain(&extra[..usize::from(stray)]).enumerate() {
        let parameters = ["", " 0 1", " 1 1 0.5", " 2 1 0.5 0.25", " 3 1"];
        let parameters = if parametric { parameters[1 + index % 4] } else { parameters[0] };
        let _ = writeln!(text, "{} {x} {y} {z}{parameters}", index + 1);
    }
    text + &format!("$End{name}\n")
}

fn nodes_4(parametric: bool) -> String {
    let flag = u8::from(parametric);
    let mut text = format!("$Nodes\n1 12 1 12\n2 1 {flag} 12\n");
    (1..=12).for_each(|tag| text += &format!("{tag}\n"));
    for [x, y, z] in NODES {
        let _ = writeln!(text, "{x} {y} {z}{}", if parametric { " 0.5 0.25" } else { "" });
    }
    text + "$EndNodes\n"
}

fn elements_4() -> String {
    let mut text = "$Entities\n0 0 2 1\n5 0 0 0 0 10 10 1 1 0\n6 20 0 0 20 10 10 2 2 4 0\n\
                    1 0 0 0 20 10 10 1 3 0\n$EndEntities\n$Elements\n3 16 1 16\n2 5 2 2\n1 4 2 1\n2 4 3 1\n2 6 2 2\n\
                    3 12 10 9\n4 12 9 11\n3 1 4 12\n"
        .to_string();
    for (index, t) in TETS.iter().enumerate() {
        let _ = writeln!(text, "{} {} {} {} {}", index + 5, t[0], t[1], t[2], t[3]);
    }
    text + "$EndElements\n"
}

/// Files of Gmsh, versions 2 to 4.1.
pub fn gmsh_files() -> Vec<Variant> {
    let mut all = Vec::new();
    let names = |tail: &str| {
        format!(
            "$PhysicalNames\n4\n2 1 \"fix\"{tail}\n2 2 \"tip\"{tail}\n3 3 \"body\"{tail}\n2 4 \"end\"\n$EndPhysicalNames\n"
        )
    };
    let starts = [
        ("nothing", "", "\n"),
        ("comments", "$Comments\nby a program\n$EndComments\n", "\n"),
        ("byte order mark", "\u{feff}", "\n"),
        ("line ends of Windows", "", "\r\n"),
        ("text", "made by a program\n\n", "\n"),
    ];
    let mut add = |name: String, text: String, stray: bool| {
        all.push(Variant { name, bytes: text.into_bytes(), sets: PLAIN, stray });
    };
    for version in ["2.2", "2.1", "2.0", "2", "4.1"] {
        for (start, head, line_end) in starts {
            for tail in ["", " some word"] {
                for parametric in [false, true] {
                    let body = match version {
                        "4.1" => {
                            let elements = elements_4();
                            let (entities, elements) = elements.split_once("$Elements").unwrap();
                            format!("{entities}{}$Elements{elements}", nodes_4(parametric))
                        }
                        _ => nodes_2(parametric, false) + &elements_2(&[], ""),
                    };
                    let text = format!(
                        "{head}$MeshFormat\n{version} 0 8\n$EndMeshFormat\n{}{body}",
                        names(tail)
                    );
                    let name = format!(
                        "version {version}; start: {start}; tail:{tail}; parametric: {parametric}"
                    );
                    add(name, text.replace('\n', line_end), false);
                }
            }
        }
    }
    let head = format!("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n{}", names(""));
    for (name, further, sign, stray) in [
        ("point", "15 2 7 7 5", "", false),
        ("point without elements", "15 2 7 7 13", "", true),
        ("line", "1 2 8 8 1 2", "", false),
        ("quadrangle", "3 2 9 9 1 2 4 3", "", false),
        ("triangle within", "2 2 9 9 1 2 12", "", false),
        ("negative group", "15 2 7 7 5", "-", false),
    ] {
        let text = format!("{head}{}{}", nodes_2(false, stray), elements_2(&[further], sign));
        add(format!("further: {name}"), text, stray);
    }
    for section in ["NodeData", "Periodic", "Comments", "Interpolation Scheme"] {
        let text = format!(
            "{head}{}${section}\n1\n2 3\n$End{section}\n{}",
            nodes_2(false, false),
            elements_2(&[], "")
        );
        add(format!("section {section}"), text, false);
    }
    all
}
