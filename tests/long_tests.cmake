# Long tests, as a filter of gtest: the slowest tests of code that other tests also cover. ctest labels them
# `long`; `./test.sh` skips them, `./test.sh all` runs them.
set(long_tests
    All/ShaderVariants.ComputeEqualClusters* Bake.ErrorFalls* Bake.HasNoBias* *BakesTheLampsOfAScene/courtyard
    BelowTheZenith.IsDimmedByAll* BlockedCap.BlocksTheCosine* ColorBleeding.* Comparison.*
    Compress.AcceptsColoredTerms* All/DemoPictures.* CompressPredictors.ShaderOperations*
    *CompressedVolumes.HaveTheExpectedError* CompressedVolumes.EvaluateTheir* *CompressedVolumes.LoseOnly*
    Culling.KeepsVisible* Diffusion.MatchesAFiner* Diffusion.IntegratesTheDipole* Diffusion.IsUniform* EndlessWall.*
    *HaveTheEstimatedError* ErrorBudget.BounceError* *HasTheEstimatedError* FallbackFiles.* FigureTest.IsLitLike*
    FirstHour.SmallMeshes* FirstHour.LargeUniformBlocks* FittedBake.BouncesAre* GpuRaster.Converges* GpuRaster.Peels*
    GpuSums.MatchTheVectors* GpuTrace.DoesNotDepend* GpuTrace.StoresCopies* IncidentReference.* Lamps.SpheresFollow*
    *LeadsFromSceneToPictures/1 *LeadsFromSceneToPictures/2 *LeadsFromSceneToPictures/3 Levels.NearestPositions*
    LevelsOfDetail.AreBaked* Light.ConeAgrees* LightmapBake.BouncesLike* LightmapBake.Converges* LightmapScript.*
    LightmapViewer.CompletesAVertexBake* LightmapViewer.HasNumbers* LightmapViewer.CombinesABake*
    LightmapViewer.ShowsVertices* Lightmaps.AreDecoded* LobesCommand.IsByteIdentical* Make.Keeps* Make.MeetsTheError*
    Make.ReportsWhy* Make.ReportsMissing* ManyReceivers.* OtherLayouts.NoiseIs* ParallelPlates.OneBounce*
    PathTracer.AgreesWith* PlainSkies.YieldNo* PlainSkies.HaveNo* RasterBake.Fills* RasterBake.Fits* RasterBake.Reaches*
    TargetError.IsReachedByFits* RenderSuns.* Pipeline.ADecoder*
    Pipeline.AutomaticExposure* Pipeline.BouncesOnTheGpu* Pipeline.EveryView* SamplingError.* SceneLamps.BakerLamps*
    Script.KeysAnd* Script.MeasuresTheErrorBudget* Script.OpensWaits* Search.MatchesAGrid* Search.IsMonotone*
    Search.IsNeverWorse* Search.Keeps* Search.LimitsJumps* Search.OperationBudget* Search.Presets*
    Search.ReportsTheTime* Search.FloatWeightsFit* Skies/Suns.* Sky.AgreesWith* SphericalBowl.* Storage.*
    Subsurface.IsFinite* SunShadowPictures.AgreeWithRays* Suns.SumWithTheRemainder* Sweep.*
    TargetError.FindsTheWindow* TargetError.IsReached* TargetError.NeedsFewer* Trace.NoCluster*
    LightmapViewer.CompressesABake* Lightmaps.TouchingBlocks* NoiseFilter.ChangesLittle* NoiseFilter.RemovesMostNoiseOfASky*
    ViewedLamp.IsRejected* GpuSums.AddNoHitTwice* Light.OvercastSky* TransferTerms.AreKept*
    LobesCommand.MeasuresLightWithATargetError* LightmapViewer.SavesTheCompressed* NoiseFilter.RemovesMostNoise
    PathTraced.ErrorsAreSmall* SideFile.ExcessiveReferences* HostileGltf.SharedMeshesAreBounded* ExampleFigure.ItsFeet*
    Kinds/VertexShader.AgreesWithCppPerVertex/7 PlainSkies.AreFinite* Search.FindsFewClusters* Trace.RecordsEveryTrial*
    LightmapBake.FiltersNoise* ViewerTest.SavesTheCompressed* Orders/VolumePass.MatchesCpp/4 Orders/VolumePass.MatchesCpp/5
    All/ShaderVariants.HaveTheBindings*/1 All/ShaderVariants.HaveTheBindings*/3 All/ShaderVariants.HaveTheBindings*/4 All/ShaderVariants.HaveTheBindings*/5 Script.EscapeCloses* FigureScript.SetsPaths* ViewerPictures.BakedOcclusion*
    SharedInstances.ErrorsDoNot* SharedInstances.KeepTheir* SharedInstances.LargeErrors* ViewerPictures.NumbersShow*
    ViewerPictures.SeparateSuns* ViewerTest.BakesAndShows* ViewerTest.LimitsTheBases* ViewerTest.ListsEvery*
    ViewerTest.OpensCompressed* ViewerTest.CombinesABake* ViewerTest.ReportsTransfer* VolumeBake.FitReduces*)
list(JOIN long_tests ":" long_tests)
