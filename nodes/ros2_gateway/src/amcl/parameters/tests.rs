use super::*;

fn double(value: f64) -> ParameterValue {
    (&Value::Double(value)).into()
}

#[test]
fn every_default_fits_its_own_parameter_and_names_are_in_order() {
    for declared in ALL {
        let value = &declared.default;
        assert_eq!(&fitting(declared, value.clone()).unwrap(), value);
    }
    assert!(ALL.is_sorted_by_key(|declared| declared.name));
}

#[test]
fn what_cannot_be_set_says_why() {
    let mut parameters = Parameters::default();
    assert_eq!(
        parameters.set("transform_tolerance", &double(0.5)).reason,
        ""
    );
    assert_eq!(parameters.number("transform_tolerance"), 0.5);
    let whole = (&Value::Integer(2)).into();
    assert!(parameters.set("transform_tolerance", &whole).successful);
    assert_eq!(parameters.number("transform_tolerance"), 2.0);
    let idle = parameters.set("alpha1", &double(0.5));
    assert!(idle.successful && !idle.reason.is_empty());
    let text: ParameterValue = (&Value::Text("odom2".into())).into();
    let array = ParameterValue {
        r#type: 8,
        ..ParameterValue::default()
    };
    for (name, value) in [
        ("transform_tolerance", &double(11.0)),
        ("transform_tolerance", &double(f64::NAN)),
        ("transform_tolerance", &text),
        ("transform_tolerance", &array),
        ("tf_broadcast", &double(1.0)),
        ("odom_frame_id", &text),
        ("none", &text),
    ] {
        let result = parameters.set(name, value);
        assert!(
            !result.successful && !result.reason.is_empty(),
            "{name}: {result:?}"
        );
    }
    // Setting the current value is allowed: tools that restore saved values do so.
    let same: ParameterValue = (&Value::Text("odom".into())).into();
    assert!(parameters.set("odom_frame_id", &same).successful);
}

#[test]
fn all_are_set_or_none() {
    let mut parameters = Parameters::default();
    let (good, bad) = (double(0.5), double(-1.0));
    let both = [("laser_max_range", &good), ("transform_tolerance", &bad)];
    assert!(!parameters.set_all(both.into_iter()).successful);
    assert_eq!(parameters.number("laser_max_range"), 100.0);
    assert!(parameters.set_all(both[..1].iter().copied()).successful);
    assert_eq!(parameters.number("laser_max_range"), 0.5);
}

#[test]
fn names_are_listed_by_prefix_and_depth() {
    let parameters = Parameters::default();
    let list = |prefixes: &[&str], depth| {
        let prefixes: Vec<String> = prefixes.iter().map(|p| (*p).to_owned()).collect();
        parameters.list(&prefixes, depth)
    };
    assert_eq!(list(&[], 0).names.len(), ALL.len());
    assert_eq!(list(&[], 1).names.len(), ALL.len() - 4);
    let pose = list(&["initial_pose"], 0);
    assert_eq!(pose.names.len(), 4);
    assert_eq!(pose.prefixes, ["initial_pose"]);
    assert_eq!(list(&["odom_frame_id", "x"], 1).names, ["odom_frame_id"]);
    assert!(list(&["initial"], 0).names.is_empty());
}

/// Names of files, frames and topics do not come over the network.
#[test]
fn no_text_that_counts_changes_while_the_node_runs() {
    let mut parameters = Parameters::default();
    let other: ParameterValue = (&Value::Text("/elsewhere/pose.yaml".into())).into();
    let texts = ALL
        .iter()
        .filter(|declared| matches!(declared.default, Value::Text(_)));
    let counting: Vec<_> = texts
        .filter(|declared| declared.counts != Counts::Never)
        .collect();
    assert!(counting.iter().any(|declared| declared.name == FILE));
    for declared in counting {
        let refused = parameters.set(declared.name, &other);
        assert!(
            !refused.successful && refused.reason.contains(declared.name),
            "{refused:?}"
        );
        let both = [
            ("tf_broadcast", &(&Value::Bool(false)).into()),
            (declared.name, &other),
        ];
        assert!(!parameters.set_all(both.into_iter()).successful);
        assert!(parameters.describe(declared.name).read_only);
    }
    assert_eq!(parameters.0, Parameters::default().0);
}
